#include "tiles/picture_stream.h"

namespace haustra::tiles {

Result<std::optional<Picture>> PictureStream::add(std::span<const std::uint8_t> payload) {
    const DecodedTile tile = TRY(decoder_.decode(payload));
    if (tile.header.viewport >= assemblers_.size())
        return fail(ErrorKind::badInput, "the server sent a tile of a viewport that cannot be",
                    "tile");
    return assemblers_[tile.header.viewport].add(tile);
}

void PictureStream::reset() {
    for (PictureAssembler& assembler : assemblers_)
        assembler.reset();
}

}  // namespace haustra::tiles
