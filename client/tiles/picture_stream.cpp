#include "tiles/picture_stream.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <string>
#include <utility>

#include <turbojpeg.h>

namespace haustra::tiles {

using protocol::TileHeader;

struct PictureStream::Jpeg {
    tjhandle handle = tjInitDecompress();
    ~Jpeg() {
        if (handle) tjDestroy(handle);
    }
};

namespace {

using Bytes = std::span<const std::uint8_t>;

std::string sizeText(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

constexpr std::size_t wordsOfRow(int width) {
    return (std::size_t(width) + 63) / 64;
}

// Where a tile goes: within its picture, as parseTileHeader has seen to.
struct Place {
    std::uint8_t* corner;
    std::size_t pitch;  // bytes from row to row
};
Place placeOf(const TileHeader& header, Picture& picture) {
    const std::size_t pitch = 4 * std::size_t(picture.width);
    return {picture.pixels.data() + header.y * pitch + 4 * std::size_t(header.x), pitch};
}

Result<void> decodeJpeg(tjhandle handle, Bytes bytes, const TileHeader& header, Place place) {
    if (!handle) return fail(ErrorKind::device, "the JPEG decoder could not start", "tile");
    int jpegWidth = 0, jpegHeight = 0, subsampling = 0, colorspace = 0;
    if (tjDecompressHeader3(handle, bytes.data(), bytes.size(), &jpegWidth, &jpegHeight,
                            &subsampling, &colorspace) != 0)
        return fail(ErrorKind::badInput, "not a JPEG picture", "tile");
    // Checked before decoding: a forged JPEG size must not choose how much memory is written.
    if (jpegWidth != header.width || jpegHeight != header.height)
        return fail(ErrorKind::badInput,
                    "the JPEG picture is " + sizeText(jpegWidth, jpegHeight) +
                        ", its tile header says " + sizeText(header.width, header.height),
                    "tile");
    // A picture can be sent in scans without end, each of which takes the time of a whole one.
    // BGRA, not BGRX: of that the library promises nothing about the fourth byte.
    if (tjDecompress2(handle, bytes.data(), bytes.size(), place.corner, header.width,
                      int(place.pitch), header.height, TJPF_BGRA, TJFLAG_LIMITSCANS) != 0)
        return fail(ErrorKind::badInput,
                    std::string("damaged JPEG data: ") + tjGetErrorStr2(handle), "tile");
    return {};
}

Result<void> decodeLossless(Bytes bytes, const TileHeader& header, Place place) {
    const auto rgb = TRY(protocol::decodeLossless(bytes, header.width, header.height));
    const std::uint8_t* from = rgb.data();
    for (int row = 0; row < header.height; ++row) {
        std::uint8_t* to = place.corner + std::size_t(row) * place.pitch;
        for (int x = 0; x < header.width; ++x, from += 3, to += 4)
            to[0] = from[2], to[1] = from[1], to[2] = from[0], to[3] = 255;
    }
    return {};
}

}  // namespace

void PictureStream::Unfinished::begin(const TileHeader& header) {
    const std::size_t count = std::size_t(header.pictureWidth) * header.pictureHeight;
    picture = Picture{};
    picture.width = header.pictureWidth;
    picture.height = header.pictureHeight;
    picture.pixels.resize(count * 4);
    picture.viewport = header.viewport;
    picture.number = header.picture;
    picture.sequence = header.sequence;
    picture.exact = header.exact;
    picture.raycaster = header.raycaster;
    picture.coarse = header.coarse();
    covered.assign(wordsOfRow(picture.width) * header.pictureHeight, 0);
    uncovered = count;
    newest = header.picture;
    open = true;
    lastSeen = false;
}

bool PictureStream::Unfinished::isOf(const TileHeader& header) const {
    return header.pictureWidth == picture.width && header.pictureHeight == picture.height &&
           header.sequence == picture.sequence && header.exact == picture.exact &&
           header.raycaster == picture.raycaster && header.coarse() == picture.coarse;
}

void PictureStream::Unfinished::cover(const TileHeader& header) {
    const unsigned end = unsigned(header.x) + header.width;
    for (std::size_t y = header.y; y < std::size_t(header.y) + header.height; ++y) {
        std::uint64_t* const row = &covered[y * wordsOfRow(picture.width)];
        for (unsigned x = header.x; x < end;) {
            const unsigned count = std::min(64 - x % 64, end - x);
            const std::uint64_t bits = ~std::uint64_t(0) >> (64 - count) << x % 64;
            uncovered -= std::size_t(std::popcount(bits & ~row[x / 64]));
            row[x / 64] |= bits;
            x += count;
        }
    }
}

PictureStream::PictureStream() : jpeg_(std::make_unique<Jpeg>()) {}
PictureStream::~PictureStream() = default;

Result<std::optional<Picture>> PictureStream::add(Bytes payload) {
    const auto start = std::chrono::steady_clock::now();
    const TileHeader header = TRY(protocol::parseTileHeader(payload));
    if (header.viewport >= unfinished_.size())
        return fail(ErrorKind::badInput, "the server sent a tile of a viewport that cannot be",
                    "tile");
    Unfinished& of = unfinished_[header.viewport];
    if (header.picture < of.newest || (header.picture == of.newest && !of.open))
        return std::nullopt;
    if (header.picture > of.newest) of.begin(header);
    if (!of.isOf(header))
        return fail(
            ErrorKind::badInput,
            "a tile contradicts the other tiles of picture " + std::to_string(header.picture),
            "tile");

    Picture& picture = of.picture;
    const Bytes coded = payload.subspan(protocol::tileHeaderBytes);
    const Place place = placeOf(header, picture);
    if (header.codec == protocol::TileCodec::jpeg) {
        TRY(decodeJpeg(jpeg_->handle, coded, header, place));
    } else {
        TRY(decodeLossless(coded, header, place));
    }
    of.cover(header);
    picture.wireBytes += payload.size();
    picture.renderMicroseconds = std::max(picture.renderMicroseconds, header.renderMicroseconds);
    picture.encodeMicroseconds = std::max(picture.encodeMicroseconds, header.encodeMicroseconds);
    picture.queueMicroseconds = std::max(picture.queueMicroseconds, header.queueMicroseconds);
    picture.decodeMs +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    of.lastSeen = of.lastSeen || header.last;
    if (!of.lastSeen || of.uncovered > 0) return std::nullopt;
    of.open = false;
    return std::optional<Picture>(std::move(picture));
}

void PictureStream::reset() {
    unfinished_ = {};
}

}  // namespace haustra::tiles
