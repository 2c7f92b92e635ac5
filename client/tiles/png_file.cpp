#include "tiles/png_file.h"

#include "core/durable_file.h"

#include <string>

#include <stb/stb_image_write.h>

namespace haustra::tiles {

Result<void> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgb,
                      int width, int height) {
    if (width <= 0 || height <= 0 || rgb.size() != std::size_t(width) * std::size_t(height) * 3)
        return fail(ErrorKind::badInput, "the picture's size and its bytes differ", file.string());
    if (rgb.size() > maxPngBytes)  // stb counts in int
        return fail(ErrorKind::badInput, "the picture is too large for a PNG file", file.string());
    std::string png;
    const auto append = [](void* to, void* bytes, int count) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), std::size_t(count));
    };
    if (stbi_write_png_to_func(append, &png, width, height, 3, rgb.data(), width * 3) == 0)
        return fail(ErrorKind::io, "there is not enough memory for the PNG file", file.string());
    return writeDurably(file, png);
}

}  // namespace haustra::tiles
