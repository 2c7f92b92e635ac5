// Tiles of one viewport become whole pictures.
#pragma once

#include "tiles/picture.h"
#include "tiles/tile_decoder.h"

#include <optional>

namespace haustra::tiles {

/// Collects the tiles of one viewport. A picture is finished when its last tile has been seen and
/// every pixel is covered, in whatever order the tiles came. A tile of a newer picture abandons
/// the unfinished one; a tile of an older picture, or of one already finished, is ignored. Belongs
/// to one thread; holds at most one picture (12 MB and a byte a pixel).
class PictureAssembler {
public:
    /// The finished picture when `tile` completes one, else nothing. Fails where a tile
    /// contradicts its picture (another size, sequence or exactness than its first tile said).
    Result<std::optional<Picture>> add(const DecodedTile& tile);

    /// Forgets everything: the server counts its pictures anew after a reconnection.
    void reset();

private:
    void begin(const protocol::TileHeader& header);

    Picture picture_;
    std::vector<std::uint8_t> covered_;
    std::size_t uncovered_ = 0;
    std::uint32_t newest_ = 0;  ///< number of the newest picture begun
    bool open_ = false;         ///< picture_ still waits for tiles
    bool lastSeen_ = false;
};

}  // namespace haustra::tiles
