#include "tiles/picture_assembler.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace haustra::tiles {

void PictureAssembler::begin(const protocol::TileHeader& header) {
    const std::size_t pixels = std::size_t(header.pictureWidth) * header.pictureHeight;
    picture_ = Picture{};
    picture_.width = header.pictureWidth;
    picture_.height = header.pictureHeight;
    picture_.rgb.assign(pixels * 3, 0);
    picture_.viewport = header.viewport;
    picture_.number = header.picture;
    picture_.sequence = header.sequence;
    picture_.exact = header.exact;
    picture_.raycaster = header.raycaster;
    picture_.coarse = header.coarse();
    covered_.assign(pixels, 0);
    uncovered_ = pixels;
    newest_ = header.picture;
    open_ = true;
    lastSeen_ = false;
}

Result<std::optional<Picture>> PictureAssembler::add(const DecodedTile& tile) {
    const protocol::TileHeader& header = tile.header;
    if (header.picture < newest_ || (header.picture == newest_ && !open_)) return std::nullopt;
    if (header.picture > newest_) begin(header);
    if (header.pictureWidth != picture_.width || header.pictureHeight != picture_.height ||
        header.sequence != picture_.sequence || header.exact != picture_.exact ||
        header.raycaster != picture_.raycaster || header.coarse() != picture_.coarse)
        return fail(
            ErrorKind::badInput,
            "a tile contradicts the other tiles of picture " + std::to_string(header.picture),
            "tile");

    const std::size_t rowPixels = header.width;
    for (std::size_t row = 0; row < header.height; ++row) {
        const std::size_t target = (header.y + row) * std::size_t(picture_.width) + header.x;
        std::memcpy(&picture_.rgb[target * 3], &tile.rgb[row * rowPixels * 3], rowPixels * 3);
        const auto covered = covered_.begin() + std::ptrdiff_t(target);
        uncovered_ -= std::size_t(std::count(covered, covered + std::ptrdiff_t(rowPixels), 0));
        std::fill_n(covered, rowPixels, 1);
    }
    picture_.wireBytes += tile.wireBytes;
    picture_.decodeMs += tile.decodeMs;
    picture_.renderMicroseconds = std::max(picture_.renderMicroseconds, header.renderMicroseconds);
    picture_.encodeMicroseconds = std::max(picture_.encodeMicroseconds, header.encodeMicroseconds);
    picture_.queueMicroseconds = std::max(picture_.queueMicroseconds, header.queueMicroseconds);
    lastSeen_ = lastSeen_ || header.last;
    if (!lastSeen_ || uncovered_ > 0) return std::nullopt;
    open_ = false;
    return std::optional<Picture>(std::move(picture_));
}

void PictureAssembler::reset() {
    *this = PictureAssembler{};
}

}  // namespace haustra::tiles
