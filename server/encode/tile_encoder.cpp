#include "encode/tile_encoder.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include <turbojpeg.h>

namespace haustra::encode {

struct TileEncoder::Jpeg {
    tjhandle handle = tjInitCompress();
    ~Jpeg() {
        if (handle) tjDestroy(handle);
    }
};
void TileEncoder::Free::operator()(Jpeg* jpeg) const {
    delete jpeg;
}

Result<TileEncoder> TileEncoder::create() {
    std::unique_ptr<Jpeg, Free> jpeg(new Jpeg);
    if (!jpeg->handle) return fail(ErrorKind::device, "libjpeg-turbo cannot start", "encoder");
    return TileEncoder(std::move(jpeg));
}

namespace {

using Bytes = std::vector<std::uint8_t>;

struct TileRectangle {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Longest side of a tile. Small tiles waste bytes (METHODS §21 "Pictures on the wire"); one of
/// this size is coded in a few milliseconds.
constexpr int maxTileSide = 512;

constexpr int blockSide = 16;  // of JPEG with 4:2:0 chroma

int partLength(int side) {
    const int parts = (side + maxTileSide - 1) / maxTileSide;
    const int length = (side + parts - 1) / parts;
    return (length + blockSide - 1) / blockSide * blockSide;
}

/// Rows of tiles from the top, each from the left, that cover the picture once. Every side of the
/// picture is cut into the fewest near-equal parts of at most maxTileSide, so that a tile is under
/// 128 pixels only where the picture is. Cuts lie on multiples of 16, where JPEG's blocks end.
std::vector<TileRectangle> layOutTiles(int width, int height) {
    std::vector<TileRectangle> tiles;
    const int tileWidth = partLength(width), tileHeight = partLength(height);
    for (int y = 0; y < height; y += tileHeight)
        for (int x = 0; x < width; x += tileWidth)
            tiles.push_back(
                {x, y, std::min(tileWidth, width - x), std::min(tileHeight, height - y)});
    return tiles;
}

Result<Bytes> encodeJpeg(tjhandle handle, const Image& image, const TileRectangle& tile) {
    Bytes bytes(tjBufSize(tile.width, tile.height, TJSAMP_420));
    unsigned char* out = bytes.data();
    unsigned long size = bytes.size();
    const std::uint8_t* first =
        image.rgb.data() +
        (std::size_t(tile.y) * std::size_t(image.width) + std::size_t(tile.x)) * 3;
    if (tjCompress2(handle, first, tile.width, image.width * 3, tile.height, TJPF_RGB, &out, &size,
                    TJSAMP_420, jpegQuality, TJFLAG_NOREALLOC) != 0) {
        return fail(ErrorKind::badInput, tjGetErrorStr2(handle), "encoder");
    }
    bytes.resize(size);
    return bytes;
}

Result<Bytes> encodeExact(const Image& image, const TileRectangle& tile) {
    Bytes rows;
    std::span<const std::uint8_t> rgb = image.rgb;
    if (tile.width != image.width || tile.height != image.height) {
        const std::size_t rowBytes = std::size_t(tile.width) * 3;
        rows.resize(rowBytes * std::size_t(tile.height));
        for (std::size_t y = 0; y < std::size_t(tile.height); ++y) {
            const std::size_t from =
                ((y + std::size_t(tile.y)) * std::size_t(image.width) + std::size_t(tile.x)) * 3;
            std::memcpy(&rows[y * rowBytes], &image.rgb[from], rowBytes);
        }
        rgb = rows;
    }
    return protocol::encodeLossless(rgb, tile.width, tile.height);
}

}  // namespace

Result<Bytes> TileEncoder::encode(const Image& image, protocol::TileHeader header) {
    const int limit = int(protocol::maxViewportPixels);
    if (image.width < 1 || image.height < 1 || image.width > limit || image.height > limit ||
        image.rgb.size() != std::size_t(image.width) * std::size_t(image.height) * 3)
        return fail(ErrorKind::badInput, "a picture's size is out of bounds", "encoder");

    const auto start = std::chrono::steady_clock::now();
    const std::vector<TileRectangle> tiles = layOutTiles(image.width, image.height);
    std::vector<Bytes> coded;
    std::size_t codedBytes = 0;
    for (const TileRectangle& tile : tiles) {
        auto bytes =
            TRY(header.codec == protocol::TileCodec::jpeg ? encodeJpeg(jpeg_->handle, image, tile)
                                                          : encodeExact(image, tile));
        codedBytes += bytes.size();
        coded.push_back(std::move(bytes));
    }
    header.encodeMicroseconds = std::uint32_t(std::chrono::duration_cast<std::chrono::microseconds>(
                                                  std::chrono::steady_clock::now() - start)
                                                  .count());
    header.pictureWidth = std::uint16_t(image.width);
    header.pictureHeight = std::uint16_t(image.height);

    Bytes frames;
    frames.reserve(codedBytes +
                   tiles.size() * (protocol::frameHeaderBytes + protocol::tileHeaderBytes));
    for (std::size_t n = 0; n < tiles.size(); ++n) {
        header.x = std::uint16_t(tiles[n].x);
        header.y = std::uint16_t(tiles[n].y);
        header.width = std::uint16_t(tiles[n].width);
        header.height = std::uint16_t(tiles[n].height);
        header.last = n + 1 == tiles.size();
        protocol::appendFrameHeader(frames,
                                    {std::uint32_t(protocol::tileHeaderBytes + coded[n].size()),
                                     protocol::FrameType::tile});
        protocol::appendTileHeader(frames, header);
        frames.insert(frames.end(), coded[n].begin(), coded[n].end());
    }
    return frames;
}

}  // namespace haustra::encode
