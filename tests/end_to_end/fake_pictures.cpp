#include "end_to_end/fake_pictures.h"

#include "protocol/framing.h"

#include <algorithm>
#include <cmath>

#include <turbojpeg.h>

namespace haustra::tests {
namespace {

std::vector<std::uint8_t> encodeJpeg(const std::vector<std::uint8_t>& rgb, int width, int height) {
    tjhandle handle = tjInitCompress();
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    tjCompress2(handle, rgb.data(), width, width * 3, height, TJPF_RGB, &bytes, &size, TJSAMP_420,
                80, 0);
    std::vector<std::uint8_t> jpeg(bytes, bytes + size);
    tjFree(bytes);
    tjDestroy(handle);
    return jpeg;
}

}  // namespace

std::vector<std::uint8_t> syntheticPicture(int width, int height, glm::dvec3 positionMm,
                                           double centerHu) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(std::size_t(width) * std::size_t(height) * 3);
    const double shift = positionMm.x + positionMm.y + positionMm.z;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            rgb.push_back(std::uint8_t(128 + 100 * std::sin(0.02 * (x + shift))));
            rgb.push_back(std::uint8_t(128 + 100 * std::sin(0.03 * (y - shift))));
            rgb.push_back(std::uint8_t(128 + 100 * std::sin(0.01 * (x + y) + 0.01 * centerHu)));
        }
    }
    return rgb;
}

std::vector<std::uint8_t> framesOf(const FakePicture& picture) {
    const auto rgb =
        syntheticPicture(picture.width, picture.height, picture.positionMm, picture.centerHu);
    constexpr int side = 128;
    std::vector<std::uint8_t> out;
    for (int y = 0; y < picture.height; y += side) {
        for (int x = 0; x < picture.width; x += side) {
            const int w = std::min(side, picture.width - x), h = std::min(side, picture.height - y);
            std::vector<std::uint8_t> tile;
            for (int row = y; row < y + h; ++row) {
                const auto start = rgb.begin() + (row * picture.width + x) * 3;
                tile.insert(tile.end(), start, start + w * 3);
            }
            std::vector<std::uint8_t> bytes =
                picture.exact ? protocol::encodeLossless(tile, w, h) : encodeJpeg(tile, w, h);
            if (picture.garbage)
                for (std::size_t n = 0; n < bytes.size(); ++n)
                    bytes[n] = std::uint8_t(n * 37 + 11);
            protocol::TileHeader header;
            header.viewport = std::uint8_t(picture.viewport);
            header.codec =
                picture.exact ? protocol::TileCodec::lossless : protocol::TileCodec::jpeg;
            header.last = x + side >= picture.width && y + side >= picture.height;
            header.exact = picture.exact;
            header.picture = picture.number;
            header.sequence = picture.sequence;
            header.pictureWidth = std::uint16_t(picture.width);
            header.pictureHeight = std::uint16_t(picture.height);
            header.x = std::uint16_t(x);
            header.y = std::uint16_t(y);
            header.width = std::uint16_t(w);
            header.height = std::uint16_t(h);
            header.renderMicroseconds = 1000;
            header.encodeMicroseconds = 200;
            header.queueMicroseconds = 30;
            std::vector<std::uint8_t> payload;
            protocol::appendTileHeader(payload, header);
            payload.insert(payload.end(), bytes.begin(), bytes.end());
            protocol::appendFrameHeader(out,
                                        {std::uint32_t(payload.size()), protocol::FrameType::tile});
            out.insert(out.end(), payload.begin(), payload.end());
        }
    }
    return out;
}

}  // namespace haustra::tests
