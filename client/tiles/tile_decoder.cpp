#include "tiles/tile_decoder.h"

#include <chrono>
#include <string>
#include <utility>

#include <turbojpeg.h>

namespace haustra::tiles {

struct TileDecoder::Jpeg {
    tjhandle handle = tjInitDecompress();
    ~Jpeg() {
        if (handle) tjDestroy(handle);
    }
};

namespace {

std::string sizeText(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

Result<std::vector<std::uint8_t>> decodeJpeg(tjhandle handle, std::span<const std::uint8_t> bytes,
                                             int width, int height) {
    if (!handle) return fail(ErrorKind::device, "the JPEG decoder could not start", "tile");
    int jpegWidth = 0, jpegHeight = 0, subsampling = 0, colorspace = 0;
    if (tjDecompressHeader3(handle, bytes.data(), bytes.size(), &jpegWidth, &jpegHeight,
                            &subsampling, &colorspace) != 0)
        return fail(ErrorKind::badInput, "not a JPEG picture", "tile");
    // Checked before decoding: a forged JPEG size must not choose how much memory is written.
    if (jpegWidth != width || jpegHeight != height)
        return fail(ErrorKind::badInput,
                    "the JPEG picture is " + sizeText(jpegWidth, jpegHeight) +
                        ", its tile header says " + sizeText(width, height),
                    "tile");
    std::vector<std::uint8_t> rgb(std::size_t(width) * std::size_t(height) * 3);
    if (tjDecompress2(handle, bytes.data(), bytes.size(), rgb.data(), width, width * 3, height,
                      TJPF_RGB, 0) != 0)
        return fail(ErrorKind::badInput,
                    std::string("damaged JPEG data: ") + tjGetErrorStr2(handle), "tile");
    return rgb;
}

}  // namespace

TileDecoder::TileDecoder() : jpeg_(std::make_unique<Jpeg>()) {}
TileDecoder::~TileDecoder() = default;
TileDecoder::TileDecoder(TileDecoder&&) noexcept = default;
TileDecoder& TileDecoder::operator=(TileDecoder&&) noexcept = default;

Result<DecodedTile> TileDecoder::decode(std::span<const std::uint8_t> payload) {
    const auto start = std::chrono::steady_clock::now();
    auto header = protocol::parseTileHeader(payload);
    if (!header) return tl::make_unexpected(std::move(header.error()));
    const auto bytes = payload.subspan(protocol::tileHeaderBytes);
    auto rgb = header->codec == protocol::TileCodec::jpeg
                   ? decodeJpeg(jpeg_->handle, bytes, header->width, header->height)
                   : protocol::decodeLossless(bytes, header->width, header->height);
    if (!rgb) return tl::make_unexpected(std::move(rgb.error()));
    DecodedTile tile;
    tile.header = *header;
    tile.rgb = std::move(*rgb);
    tile.wireBytes = payload.size();
    tile.decodeMs =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return tile;
}

}  // namespace haustra::tiles
