#include "render/png_file.h"

#include <csetjmp>
#include <cstdio>
#include <string>
#include <system_error>
#include <vector>

#include <png.h>
#include <unistd.h>

namespace haustra::render {

namespace {

/// Whether libpng wrote it all. Nothing here has a destructor: libpng leaves by longjmp.
bool encode(std::FILE* out, const Image& image, png_bytep* rows) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_init_io(png, out);
    png_set_IHDR(png, info, png_uint_32(image.width), png_uint_32(image.height), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_rows(png, info, rows);
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &info);
    return true;
}

}  // namespace

Result<void> writePng(const std::filesystem::path& file, const Image& image) {
    const std::size_t stride = 3 * std::size_t(image.width);
    if (image.width <= 0 || image.height <= 0 ||
        image.rgb.size() != stride * std::size_t(image.height))
        return fail(ErrorKind::badInput, "the picture's size and its pixels disagree",
                    file.string());
    std::vector<png_bytep> rows;
    for (int y = 0; y < image.height; ++y)
        rows.push_back(const_cast<png_bytep>(image.rgb.data() + stride * std::size_t(y)));

    const std::string temporary = file.string() + "." + std::to_string(getpid()) + ".tmp";
    std::FILE* out = std::fopen(temporary.c_str(), "wb");
    if (!out) return fail(ErrorKind::io, "cannot be opened for writing", file.string());
    const bool encoded = encode(out, image, rows.data());
    const bool closed = std::fclose(out) == 0;
    std::error_code error;
    if (encoded && closed) std::filesystem::rename(temporary, file, error);
    if (!encoded || !closed || error) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        return fail(ErrorKind::io, "cannot be written whole", file.string());
    }
    return {};
}

}  // namespace haustra::render
