// Pictures that programs wrote, read back.
#pragma once

#include "render/picture.h"

#include <string>

#include <gtest/gtest.h>
#include <png.h>

namespace haustra::tests {

/// The file's pixels; a failure of the test, and no pixels, where it is no PNG.
inline render::Image readPng(const std::string& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&png, file.c_str())) << file;
    png.format = PNG_FORMAT_RGB;
    render::Image image{int(png.width), int(png.height),
                        std::vector<std::uint8_t>(PNG_IMAGE_SIZE(png))};
    EXPECT_TRUE(png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr)) << file;
    return image;
}

}  // namespace haustra::tests
