// Pictures to PNG files.
#pragma once

#include "render/picture.h"

#include <filesystem>
#include <memory>

namespace haustra::render {

/// A PNG file that is written band by band, from the top: 8-bit RGB, marked sRGB. Written under a
/// temporary name beside the file and renamed at the end, so that a reader never sees half a
/// picture; one that is not finished leaves nothing. Belongs to one thread.
class PngFile {
public:
    static Result<PngFile> create(const std::filesystem::path& file, int width, int height);
    ~PngFile();
    PngFile(PngFile&&) noexcept;
    PngFile& operator=(PngFile&&) noexcept;

    /// Appends rows of the file's width.
    Result<void> append(const Image& band);
    /// After the last row: the file is there. The same rows give the same bytes, in whatever bands.
    Result<void> finish();

private:
    struct Writer;
    explicit PngFile(std::unique_ptr<Writer> writer);
    std::unique_ptr<Writer> writer_;
};

/// A whole picture at once, likewise.
Result<void> writePng(const std::filesystem::path& file, const Image& image);

}  // namespace haustra::render
