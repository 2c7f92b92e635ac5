#include "protocol/framing.h"

#include <google/protobuf/message_lite.h>

namespace haustra::protocol {
namespace {

template <class T>
void append(std::vector<std::uint8_t>& out, T value) {
    for (std::size_t byte = 0; byte < sizeof(T); ++byte)
        out.push_back(std::uint8_t(value >> (8 * byte)));
}

// Reads little-endian integers in order. The caller has checked that there are enough bytes.
class Reader {
public:
    explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    template <class T>
    T take() {
        T value = 0;
        for (std::size_t byte = 0; byte < sizeof(T); ++byte)
            value = T(value | T(T(bytes_[byte]) << (8 * byte)));
        bytes_ = bytes_.subspan(sizeof(T));
        return value;
    }

private:
    std::span<const std::uint8_t> bytes_;
};

tl::unexpected<Error> malformed(std::string message) {
    return fail(ErrorKind::badInput, std::move(message), "protocol");
}

constexpr std::uint8_t lastFlag = 1, exactFlag = 2;
constexpr std::size_t reservedBytes = 10;

}  // namespace

void appendFrameHeader(std::vector<std::uint8_t>& out, FrameHeader header) {
    append(out, header.payloadBytes);
    append(out, std::uint8_t(header.type));
}

std::vector<std::uint8_t> controlFrame(const google::protobuf::MessageLite& message) {
    const std::size_t bytes = message.ByteSizeLong();
    std::vector<std::uint8_t> frame;
    frame.reserve(frameHeaderBytes + bytes);
    appendFrameHeader(frame, {std::uint32_t(bytes), FrameType::control});
    frame.resize(frame.size() + bytes);
    message.SerializeToArray(frame.data() + frameHeaderBytes, int(bytes));
    return frame;
}

Result<FrameHeader> parseFrameHeader(std::span<const std::uint8_t> bytes, FrameLimits limits) {
    if (bytes.size() < frameHeaderBytes) return malformed("a frame header is 5 bytes");
    Reader reader(bytes);
    FrameHeader header;
    header.payloadBytes = reader.take<std::uint32_t>();
    const auto type = reader.take<std::uint8_t>();
    std::uint32_t limit = 0;
    switch (type) {
        case std::uint8_t(FrameType::control):
            limit = limits.maxControlBytes;
            break;
        case std::uint8_t(FrameType::tile):
            limit = limits.maxTileBytes;
            break;
        default:
            return malformed("no frame has the type " + std::to_string(type));
    }
    header.type = FrameType(type);
    if (limit == 0)
        return malformed("a frame of type " + std::to_string(type) + " does not go this way");
    if (header.payloadBytes > limit) {
        return malformed("a frame of " + std::to_string(header.payloadBytes) +
                         " bytes is over the bound of " + std::to_string(limit));
    }
    return header;
}

void appendTileHeader(std::vector<std::uint8_t>& out, const TileHeader& header) {
    append(out, header.viewport);
    append(out, std::uint8_t(header.codec));
    append(out, std::uint8_t((header.last ? lastFlag : 0) | (header.exact ? exactFlag : 0)));
    append(out, std::uint8_t(0));
    append(out, header.picture);
    append(out, header.sequence);
    for (std::uint16_t value : {header.pictureWidth, header.pictureHeight, header.x, header.y,
                                header.width, header.height}) {
        append(out, value);
    }
    append(out, header.renderMicroseconds);
    append(out, header.encodeMicroseconds);
    append(out, header.queueMicroseconds);
    append(out, header.raycaster);
    append(out, std::uint8_t(0));
    append(out, header.viewportWidth);
    append(out, header.viewportHeight);
    out.insert(out.end(), reservedBytes, 0);
}

Result<TileHeader> parseTileHeader(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < tileHeaderBytes) return malformed("a tile header is 56 bytes");
    Reader reader(bytes);
    TileHeader header;
    header.viewport = reader.take<std::uint8_t>();
    const auto codec = reader.take<std::uint8_t>();
    const auto flags = reader.take<std::uint8_t>();
    reader.take<std::uint8_t>();
    header.picture = reader.take<std::uint32_t>();
    header.sequence = reader.take<std::uint64_t>();
    for (std::uint16_t* field : {&header.pictureWidth, &header.pictureHeight, &header.x, &header.y,
                                 &header.width, &header.height}) {
        *field = reader.take<std::uint16_t>();
    }
    header.renderMicroseconds = reader.take<std::uint32_t>();
    header.encodeMicroseconds = reader.take<std::uint32_t>();
    header.queueMicroseconds = reader.take<std::uint32_t>();
    header.raycaster = reader.take<std::uint8_t>();
    reader.take<std::uint8_t>();
    header.viewportWidth = reader.take<std::uint16_t>();
    header.viewportHeight = reader.take<std::uint16_t>();
    header.last = flags & lastFlag;
    header.exact = flags & exactFlag;

    if (header.viewport >= maxViewports)
        return malformed("a tile names viewport " + std::to_string(header.viewport));
    if (codec != std::uint8_t(TileCodec::jpeg) && codec != std::uint8_t(TileCodec::lossless)) {
        return malformed("a tile names the codec " + std::to_string(codec));
    }
    header.codec = TileCodec(codec);
    if (header.pictureWidth == 0 || header.pictureHeight == 0 ||
        header.pictureWidth > maxViewportPixels || header.pictureHeight > maxViewportPixels) {
        return malformed("a tile's picture is " + std::to_string(header.pictureWidth) + "x" +
                         std::to_string(header.pictureHeight));
    }
    if (header.width == 0 || header.height == 0 || header.x + header.width > header.pictureWidth ||
        header.y + header.height > header.pictureHeight) {
        return malformed("a tile lies outside its picture");
    }
    if (header.viewportWidth > maxViewportPixels || header.viewportHeight > maxViewportPixels ||
        (header.viewportWidth > 0 && header.viewportWidth < header.pictureWidth) ||
        (header.viewportHeight > 0 && header.viewportHeight < header.pictureHeight))
        return malformed("a tile's picture does not fit into its viewport");
    return header;
}

}  // namespace haustra::protocol
