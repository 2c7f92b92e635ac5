#include "render/wall/wall_paint.h"

#include "core/flat_map.h"
#include "core/parallel.h"
#include "core/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace haustra::render {

namespace {

constexpr std::size_t rowsAtOnce = 16;

std::array<double, 256> linearOfBytes() {
    std::array<double, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = linearLight(double(i) / 255.0);
    return table;
}

/// Bytes of linear light in steps of 1/65535, far finer than a byte's.
std::vector<std::uint8_t> bytesOfLinear() {
    std::vector<std::uint8_t> table(65536);
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = std::uint8_t(std::lround(255.0 * displayedLight(double(i) / 65535.0)));
    return table;
}

void tintPixel(std::uint8_t* rgb, glm::u8vec4 color) {
    static const std::array<double, 256> linear = linearOfBytes();
    static const std::vector<std::uint8_t> bytes = bytesOfLinear();
    if (color.a == 0) return;
    const double light = linear[std::max({rgb[0], rgb[1], rgb[2]})], share = color.a / 255.0;
    for (int c = 0; c < 3; ++c) {
        const double mixed = glm::mix(linear[rgb[c]], light * linear[std::size_t(color[c])], share);
        rgb[c] = bytes[std::size_t(65535.0 * mixed + 0.5)];
    }
}

Result<void> checkSize(double width, double height) {
    if (width >= 1 && height >= 1 && width <= maxPaintSide && height <= maxPaintSide) return {};
    return fail(
        ErrorKind::badInput,
        "the picture's sides are not within 1 to " + std::to_string(maxPaintSide) + " pixels",
        "wall paint");
}

}  // namespace

glm::u8vec4 WallPaint::at(glm::dvec2 flat) const {
    if (!(flat.y >= 0.0 && flat.y <= height) || !std::isfinite(flat.x)) return glm::u8vec4(0);
    const glm::dvec2 place =
        glm::dvec2(1.0 - (flat.x - std::floor(flat.x)), 1.0 - flat.y / height) * glm::dvec2(size);
    const auto pixel = [&](int x, int y) {
        return pixels[std::size_t(y) * std::size_t(size.x) + std::size_t(x)];
    };
    if (!smooth) {
        const glm::ivec2 in = glm::clamp(glm::ivec2(glm::floor(place)), glm::ivec2(0), size - 1);
        return pixel(in.x, in.y);
    }
    const glm::dvec2 low = glm::floor(place - 0.5);
    const glm::vec2 part(place - 0.5 - low);
    const int left = (int(low.x) + size.x) % size.x, right = (left + 1) % size.x,
              top = std::clamp(int(low.y), 0, size.y - 1),
              bottom = std::clamp(int(low.y) + 1, 0, size.y - 1);
    const glm::u8vec4 corners[4] = {pixel(left, top), pixel(right, top), pixel(left, bottom),
                                    pixel(right, bottom)};
    if (corners[0] == corners[1] && corners[0] == corners[2] && corners[0] == corners[3])
        return corners[0];
    const float weights[4] = {(1 - part.x) * (1 - part.y), part.x * (1 - part.y),
                              (1 - part.x) * part.y, part.x * part.y};
    // What covers nothing has no colour to mix in.
    glm::vec3 color(0.0f);
    float cover = 0.0f;
    for (int n = 0; n < 4; ++n) {
        color += weights[n] * float(corners[n].a) * glm::vec3(corners[n]);
        cover += weights[n] * float(corners[n].a);
    }
    if (!(cover > 0.0f)) return glm::u8vec4(0);
    return glm::u8vec4(glm::clamp(glm::round(glm::vec4(color / cover, cover)), 0.0f, 255.0f));
}

Result<void> checkWallPaint(const WallPaint& paint) {
    TRY(checkSize(paint.size.x, paint.size.y));
    if (paint.pixels.size() != std::size_t(paint.size.x) * std::size_t(paint.size.y))
        return fail(ErrorKind::badInput, "the number of pixels is not the picture's", "wall paint");
    if (!(paint.height > 0.0 && paint.height <= maxFlatHeight))
        return fail(ErrorKind::badInput, "the strip has no height or is too long", "wall paint");
    return {};
}

void tint(std::span<const WallPixel> seen, const WallPaint& paint, const Band& band, Image& picture,
          int threads) {
    const std::size_t width = std::size_t(band.pictureSize.x);
    std::uint8_t* const rgb = &picture.rgb[3 * width * std::size_t(band.firstRow)];
    parallelFor(std::size_t(band.rows), rowsAtOnce, threads,
                [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin * width; i < end * width; ++i)
                        if (seen[i].seen()) tintPixel(rgb + 3 * i, paint.at(seen[i].flat));
                });
}

void tint(const FlatWindow& window, const WallPaint& paint, const Band& band, Image& rows,
          int threads) {
    const std::size_t width = std::size_t(band.pictureSize.x);
    parallelFor(
        std::size_t(band.rows), rowsAtOnce, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t y = begin; y < end; ++y)
                for (std::size_t x = 0; x < width; ++x)
                    tintPixel(&rows.rgb[3 * (y * width + x)],
                              paint.at(window.flatFromPixel(
                                  {double(x) + 0.5, double(band.firstRow) + double(y) + 0.5},
                                  band.pictureSize)));
        });
}

}  // namespace haustra::render
