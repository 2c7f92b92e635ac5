#include "tiles/png_file.h"

#include <fstream>
#include <system_error>

#include <stb/stb_image_write.h>
#include <unistd.h>

namespace haustra::tiles {

Result<void> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgb,
                      int width, int height) {
    if (width <= 0 || height <= 0 || rgb.size() != std::size_t(width) * std::size_t(height) * 3)
        return fail(ErrorKind::badInput, "the picture's size and its bytes differ", file.string());
    if (rgb.size() > maxPngBytes)  // stb counts in int
        return fail(ErrorKind::badInput, "the picture is too large for a PNG file", file.string());
    const std::string temporary = file.string() + "." + std::to_string(::getpid()) + ".tmp";
    std::ofstream out(temporary, std::ios::binary);
    const auto write = [](void* stream, void* bytes, int count) {
        static_cast<std::ofstream*>(stream)->write(static_cast<const char*>(bytes), count);
    };
    const bool encoded =
        out && stbi_write_png_to_func(write, &out, width, height, 3, rgb.data(), width * 3) != 0;
    out.close();
    std::error_code error;
    if (encoded && out) std::filesystem::rename(temporary, file, error);
    if (encoded && out && !error) return {};
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    return fail(ErrorKind::io, "cannot write the PNG file", file.string());
}

}  // namespace haustra::tiles
