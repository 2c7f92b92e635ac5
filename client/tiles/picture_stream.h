// The tiles of one link become whole pictures.
#pragma once

#include "protocol/limits.h"
#include "tiles/picture_assembler.h"
#include "tiles/tile_decoder.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace haustra::tiles {

/// Decodes tiles of all viewports as they come. Belongs to one thread.
class PictureStream {
public:
    /// The finished picture when the tile completes one, else nothing. Fails (badInput) where the
    /// bytes are no sound tile, its viewport cannot be, or it contradicts its picture.
    Result<std::optional<Picture>> add(std::span<const std::uint8_t> payload);

    /// Another link: its server counts its pictures anew.
    void reset();

private:
    TileDecoder decoder_;
    std::array<PictureAssembler, protocol::maxViewports> assemblers_;
};

}  // namespace haustra::tiles
