// Picture files, in and out (OpenImageIO).
#pragma once

#include "core/image.h"
#include "core/result.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::pictures {

/// What pictures are written as, by the ending of the file's name: PNG and TIFF hold the pixels as
/// they are; EXR holds them as linear light, in halves, from which the same bytes can be told; JPEG
/// loses some of them (quality 95, colours in full resolution).
const std::vector<std::string>& fileEndings();
/// Whether the file's name has one of the endings, in small letters.
bool isPictureFile(const std::filesystem::path& file);
/// Longest side, pixels, of a picture in the format that the file's ending names: 65,500 of JPEG
/// and a million of PNG, their libraries' own limits; of the others any.
int mostSide(const std::filesystem::path& file);

/// Where a picture comes from. It goes into the file as text that every program shows: `software`
/// as its Software, the facts as its ImageDescription, "name=value; name=value" (`oiiotool --info
/// -v`). Never a patient's name or ID, and no path, which may hold one. What is not printable
/// ASCII becomes '?'.
struct Provenance {
    std::string software;
    std::vector<std::pair<std::string, std::string>> facts;
};

/// A picture that is written band by band, from the top. Written under a temporary name beside the
/// file, on the disk before it is renamed at the end, so that a reader never sees half a picture;
/// one that is not finished leaves nothing. The same rows and provenance give the same bytes, in
/// whatever bands. Belongs to one thread.
class PictureFile {
public:
    virtual ~PictureFile() = default;
    /// Appends rows of the file's width.
    virtual Result<void> append(const Image& band) = 0;
    /// After the last row: the file is there.
    virtual Result<void> finish() = 0;
};

/// Fails, as the file's own functions do, naming the file; where a side is over mostSide, before
/// anything is made.
Result<std::unique_ptr<PictureFile>> createPicture(const std::filesystem::path& file, int width,
                                                   int height, const Provenance& provenance);

/// A whole picture at once, likewise.
Result<void> writePicture(const std::filesystem::path& file, const Image& image,
                          const Provenance& provenance);

/// A slice of a scan: rows from the top.
struct GreyPicture {
    glm::ivec2 size{0};
    std::vector<std::int16_t> values;
};
/// Longest side of a grey picture, pixels.
inline constexpr int maxGreySide = 1 << 14;

/// A PNG or TIFF file, told by its first bytes, with one grey channel of 8 or 16 bits (PNG: of
/// fewer too, spread over 8). Values stay as they are; over 32767 they become that. Fails naming
/// the file where it is of another kind, larger, holds several pictures or is damaged.
Result<GreyPicture> readGreyPicture(const std::filesystem::path& file);

struct ColorPicture {
    glm::ivec2 size{0};
    std::vector<glm::u8vec4> pixels;  ///< rows from the top; sRGB, and how much it covers
};
/// A PNG, TIFF or JPEG file of any kind of pixel, in 8 bits: without an alpha channel it covers
/// all. Fails naming the file, likewise, and where a side is over `maxSide`.
Result<ColorPicture> readColorPicture(const std::filesystem::path& file, int maxSide);

}  // namespace haustra::pictures
