// Lossless pictures: reversible colour transform, MED prediction, zstd (PROTOCOL.md §6).
#include "protocol/framing.h"

#include <algorithm>

#include <zstd.h>

namespace haustra::protocol {
namespace {

// The median edge detector of LOCO-I (Weinberger, Seroussi, Sapiro 2000, eq. 1). Written without
// branches: the median of left, above and left + above − corner.
inline int predict(int left, int above, int corner) {
    return std::clamp(left + above - corner, std::min(left, above), std::max(left, above));
}

// Green stays; red and blue become differences to it, modulo 256 (the transform of lossless WebP).
void toDifferences(const std::uint8_t* rgb, std::size_t width, std::uint8_t* green,
                   std::uint8_t* red, std::uint8_t* blue) {
    for (std::size_t x = 0; x < width; ++x, rgb += 3) {
        green[x] = rgb[1];
        red[x] = std::uint8_t(rgb[0] - rgb[1]);
        blue[x] = std::uint8_t(rgb[2] - rgb[1]);
    }
}

constexpr int planes = 3;

}  // namespace

std::vector<std::uint8_t> encodeLossless(std::span<const std::uint8_t> rgb, int width, int height) {
    const std::size_t w = std::size_t(width), h = std::size_t(height), plane = w * h;
    std::vector<std::uint8_t> residuals(plane * planes);
    // One row above with a pixel of margin to the left; zero before the first row.
    const std::size_t stride = w + 1;
    std::vector<std::uint8_t> above(stride * planes, 0), current(stride * planes, 0);
    for (std::size_t y = 0; y < h; ++y) {
        toDifferences(rgb.data() + y * w * 3, w, &current[1], &current[stride + 1],
                      &current[2 * stride + 1]);
        for (int p = 0; p < planes; ++p) {
            std::uint8_t* const row = &current[p * stride];
            const std::uint8_t* const up = &above[p * stride];
            row[0] = up[1];  // left of the first pixel stands the pixel above it
            std::uint8_t* const out = &residuals[p * plane + y * w];
            for (std::size_t x = 0; x < w; ++x) {
                const int corner = x == 0 ? up[1] : up[x];
                out[x] = std::uint8_t(row[x + 1] - predict(row[x], up[x + 1], corner));
            }
        }
        std::swap(above, current);
    }
    std::vector<std::uint8_t> out(ZSTD_compressBound(residuals.size()));
    const std::size_t size =
        ZSTD_compress(out.data(), out.size(), residuals.data(), residuals.size(), -1);
    if (ZSTD_isError(size)) return {};
    out.resize(size);
    return out;
}

Result<std::vector<std::uint8_t>> decodeLossless(std::span<const std::uint8_t> bytes, int width,
                                                 int height) {
    const std::size_t limit = maxViewportPixels;
    if (width < 1 || height < 1 || std::size_t(width) > limit || std::size_t(height) > limit) {
        return fail(ErrorKind::badInput, "a lossless tile's size is out of bounds", "protocol");
    }
    const std::size_t w = std::size_t(width), h = std::size_t(height), plane = w * h;
    std::vector<std::uint8_t> residuals(plane * planes);
    // The output buffer bounds what a hostile stream can unpack to.
    const std::size_t size =
        ZSTD_decompress(residuals.data(), residuals.size(), bytes.data(), bytes.size());
    if (ZSTD_isError(size) || size != residuals.size()) {
        return fail(ErrorKind::badInput, "a lossless tile does not unpack to its size", "protocol");
    }
    std::vector<std::uint8_t> rgb(plane * 3);
    const std::size_t stride = w + 1;
    std::vector<std::uint8_t> above(stride * planes, 0), current(stride * planes, 0);
    for (std::size_t y = 0; y < h; ++y) {
        for (int p = 0; p < planes; ++p) {
            std::uint8_t* const row = &current[p * stride];
            const std::uint8_t* const up = &above[p * stride];
            row[0] = up[1];
            const std::uint8_t* const in = &residuals[p * plane + y * w];
            for (std::size_t x = 0; x < w; ++x) {
                const int corner = x == 0 ? up[1] : up[x];
                row[x + 1] = std::uint8_t(in[x] + predict(row[x], up[x + 1], corner));
            }
        }
        std::uint8_t* out = rgb.data() + y * w * 3;
        for (std::size_t x = 0; x < w; ++x, out += 3) {
            const std::uint8_t green = current[x + 1];
            out[0] = std::uint8_t(current[stride + x + 1] + green);
            out[1] = green;
            out[2] = std::uint8_t(current[2 * stride + x + 1] + green);
        }
        std::swap(above, current);
    }
    return rgb;
}

}  // namespace haustra::protocol
