// Grey picture files as other programs write them.
#pragma once

#include <filesystem>

#include <OpenImageIO/imageio.h>
#include <glm/glm.hpp>
#include <gtest/gtest.h>

namespace haustra::tests {

/// `pixels` with `channels` values each, in T's own bits; the format is by the file's ending.
template <class T>
void writePixels(const std::filesystem::path& file, const T* pixels, glm::ivec2 size,
                 int channels = 1, bool tiled = false) {
    const auto out = OIIO::ImageOutput::create(file.string());
    ASSERT_TRUE(out);
    OIIO::ImageSpec spec(size.x, size.y, channels, OIIO::BaseTypeFromC<T>::value);
    if (tiled) spec.tile_width = spec.tile_height = 16;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    ASSERT_TRUE(out->open(file.string(), spec)) << out->geterror();
    ASSERT_TRUE(out->write_image(spec.format, pixels)) << out->geterror();
    ASSERT_TRUE(out->close());
}

}  // namespace haustra::tests
