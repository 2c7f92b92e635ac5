// One tile's payload (header and codec bytes, PROTOCOL.md §5) becomes pixels.
#pragma once

#include "protocol/framing.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace haustra::tiles {

struct DecodedTile {
    protocol::TileHeader header;
    std::vector<std::uint8_t> rgb;  ///< header.width · header.height · 3 bytes, rows from the top
    std::size_t wireBytes = 0;
    double decodeMs = 0.0;
};

/// Decodes JPEG and lossless tiles. Belongs to one thread; keeps the JPEG library's state between
/// tiles. Any bytes are safe: what is not a sound tile is refused with the reason. About 1 ms for
/// 512×512 pixels of JPEG, 3 ms of lossless.
class TileDecoder {
public:
    TileDecoder();
    ~TileDecoder();
    TileDecoder(TileDecoder&&) noexcept;
    TileDecoder& operator=(TileDecoder&&) noexcept;

    Result<DecodedTile> decode(std::span<const std::uint8_t> payload);

private:
    struct Jpeg;
    std::unique_ptr<Jpeg> jpeg_;
};

}  // namespace haustra::tiles
