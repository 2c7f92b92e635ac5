#include "render/png_file.h"

#include <csetjmp>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include <png.h>
#include <unistd.h>

namespace haustra::render {

// libpng leaves by longjmp: in the functions that call it nothing has a destructor.
struct PngFile::Writer {
    std::filesystem::path file;
    std::string temporary;
    int width, height, rowsWritten = 0;
    std::FILE* out = nullptr;
    png_structp png = nullptr;
    png_infop info = nullptr;

    ~Writer() {
        png_destroy_write_struct(&png, &info);
        if (!out) return;
        std::fclose(out);
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
    }

    bool begin() {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
        info = png ? png_create_info_struct(png) : nullptr;
        if (!info || setjmp(png_jmpbuf(png))) return false;
        png_init_io(png, out);
        png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), 8, PNG_COLOR_TYPE_RGB,
                     PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
        png_write_info(png, info);
        return true;
    }
    bool write(const std::uint8_t* rgb, int rows) {
        if (setjmp(png_jmpbuf(png))) return false;
        for (int y = 0; y < rows; ++y)
            png_write_row(png, rgb + 3 * std::size_t(width) * std::size_t(y));
        return true;
    }
    bool end() {
        if (setjmp(png_jmpbuf(png))) return false;
        png_write_end(png, info);
        return true;
    }
    tl::unexpected<Error> notWhole() const {
        return fail(ErrorKind::io, "cannot be written whole", file.string());
    }
};

PngFile::PngFile(std::unique_ptr<Writer> writer) : writer_(std::move(writer)) {}
PngFile::~PngFile() = default;
PngFile::PngFile(PngFile&&) noexcept = default;
PngFile& PngFile::operator=(PngFile&&) noexcept = default;

Result<PngFile> PngFile::create(const std::filesystem::path& file, int width, int height) {
    if (width <= 0 || height <= 0)
        return fail(ErrorKind::badInput, "a picture has no pixels", file.string());
    auto writer = std::make_unique<Writer>();
    writer->file = file;
    writer->temporary = file.string() + "." + std::to_string(getpid()) + ".tmp";
    writer->width = width;
    writer->height = height;
    writer->out = std::fopen(writer->temporary.c_str(), "wb");
    if (!writer->out) return fail(ErrorKind::io, "cannot be opened for writing", file.string());
    if (!writer->begin()) return writer->notWhole();
    return PngFile(std::move(writer));
}

Result<void> PngFile::append(const Image& band) {
    Writer& my = *writer_;
    if (band.width != my.width || band.height < 0 || band.height > my.height - my.rowsWritten ||
        band.rgb.size() != 3 * std::size_t(band.width) * std::size_t(band.height))
        return fail(ErrorKind::badInput, "the picture's size and its pixels disagree",
                    my.file.string());
    if (!my.write(band.rgb.data(), band.height)) return my.notWhole();
    my.rowsWritten += band.height;
    return {};
}

Result<void> PngFile::finish() {
    Writer& my = *writer_;
    if (my.rowsWritten != my.height)
        return fail(ErrorKind::badInput, "the picture's size and its pixels disagree",
                    my.file.string());
    const bool ended = my.end();
    const bool closed = std::fclose(std::exchange(my.out, nullptr)) == 0;
    std::error_code error;
    if (ended && closed) std::filesystem::rename(my.temporary, my.file, error);
    if (!ended || !closed || error) {
        std::error_code ignored;
        std::filesystem::remove(my.temporary, ignored);
        return my.notWhole();
    }
    return {};
}

Result<void> writePng(const std::filesystem::path& file, const Image& image) {
    return PngFile::create(file, image.width, image.height).and_then([&](PngFile png) {
        return png.append(image).and_then([&] { return png.finish(); });
    });
}

}  // namespace haustra::render
