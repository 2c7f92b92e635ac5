// Frames on the wire, and the fixed header of a tile. PROTOCOL.md §3 and §5 are normative.
// Everything here works on bytes in memory: no sockets, no threads.
#pragma once

#include "core/result.h"
#include "protocol/limits.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace google::protobuf {
class MessageLite;
}

namespace haustra::protocol {

inline constexpr std::uint32_t protocolVersion = 1;

/// A frame is: u32 payload length, u8 type, then the payload. All integers little-endian.
enum class FrameType : std::uint8_t { control = 1, tile = 2 };
inline constexpr std::size_t frameHeaderBytes = 5;

struct FrameHeader {
    std::uint32_t payloadBytes = 0;
    FrameType type = FrameType::control;
};

/// What a receiver accepts: a server takes no tiles.
struct FrameLimits {
    std::uint32_t maxControlBytes;
    std::uint32_t maxTileBytes;
};
inline constexpr FrameLimits serverReceives{maxClientControlBytes, 0};
inline constexpr FrameLimits clientReceives{maxServerControlBytes, maxTileBytes};

void appendFrameHeader(std::vector<std::uint8_t>& out, FrameHeader header);
/// A whole frame with this message.
std::vector<std::uint8_t> controlFrame(const google::protobuf::MessageLite& message);
/// `bytes` holds frameHeaderBytes. Fails on an unknown type or a length past its bound.
Result<FrameHeader> parseFrameHeader(std::span<const std::uint8_t> bytes, FrameLimits limits);

enum class TileCodec : std::uint8_t { jpeg = 1, lossless = 2 };

/// Fixed header of a tile's payload, followed by the codec's bytes. On the wire 56 bytes:
/// viewport u8, codec u8, flags u8 (bit 0: last tile of its picture; bit 1: exact still), 0 u8,
/// picture u32, sequence u64, pictureWidth u16, pictureHeight u16, x u16, y u16, width u16,
/// height u16, renderMicroseconds u32, encodeMicroseconds u32, queueMicroseconds u32, raycaster u8,
/// 0 u8, viewportWidth u16, viewportHeight u16, 10 bytes 0.
struct TileHeader {
    std::uint8_t viewport = 0;
    TileCodec codec = TileCodec::jpeg;
    bool last = false;
    bool exact = false;
    std::uint32_t picture = 0;   ///< counts the pictures of a session, from 1
    std::uint64_t sequence = 0;  ///< newest input that this picture answers
    std::uint16_t pictureWidth = 0, pictureHeight = 0;
    std::uint16_t x = 0, y = 0, width = 0, height = 0;
    std::uint32_t renderMicroseconds = 0, encodeMicroseconds = 0;
    std::uint32_t queueMicroseconds = 0;  ///< from the input's arrival to the start of rendering
    std::uint8_t raycaster = 0;  ///< that draws the case (wireId of core/raycasters.h); 0: not told
    /// The viewport that the picture fills; where it is coarse, larger than the picture. 0: not
    /// told, as large as the picture.
    std::uint16_t viewportWidth = 0, viewportHeight = 0;
    bool coarse() const { return viewportWidth > pictureWidth || viewportHeight > pictureHeight; }
};
inline constexpr std::size_t tileHeaderBytes = 56;

void appendTileHeader(std::vector<std::uint8_t>& out, const TileHeader& header);
/// Fails unless the tile lies within its picture and the picture within the bounds.
Result<TileHeader> parseTileHeader(std::span<const std::uint8_t> bytes);

/// Lossless pictures: the MED (LOCO-I) prediction residual of a reversible colour transform,
/// zstd-compressed (METHODS §21 "Pictures on the wire"). `rgb` is width·height·3 bytes.
std::vector<std::uint8_t> encodeLossless(std::span<const std::uint8_t> rgb, int width, int height);
Result<std::vector<std::uint8_t>> decodeLossless(std::span<const std::uint8_t> bytes, int width,
                                                 int height);

}  // namespace haustra::protocol
