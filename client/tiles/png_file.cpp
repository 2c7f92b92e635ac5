#include "tiles/png_file.h"

#include <png.h>

namespace haustra::tiles {

Result<void> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgb,
                      int width, int height) {
    if (width <= 0 || height <= 0 || rgb.size() != std::size_t(width) * std::size_t(height) * 3)
        return fail(ErrorKind::badInput, "the picture's size and its bytes differ", file.string());
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = png_uint_32(width);
    image.height = png_uint_32(height);
    image.format = PNG_FORMAT_RGB;
    if (!png_image_write_to_file(&image, file.c_str(), 0, rgb.data(), width * 3, nullptr))
        return fail(ErrorKind::io, std::string("cannot write the PNG file: ") + image.message,
                    file.string());
    return {};
}

}  // namespace haustra::tiles
