#include "render/flat/flat_coverage.h"

#include <algorithm>
#include <cmath>

namespace haustra::render {

namespace {

// Pixels are cut into this many parts; coordinates below are in these.
constexpr std::int64_t parts = 256;

using Corner = glm::i64vec2;

std::int64_t floorDivide(std::int64_t a, std::int64_t b) {
    const std::int64_t quotient = a / b;
    return quotient - (a % b != 0 && (a % b < 0) != (b < 0) ? 1 : 0);
}
std::int64_t ceilDivide(std::int64_t a, std::int64_t b) {
    return -floorDivide(-a, b);
}

struct Span {
    std::int64_t first, last;
};

/// Narrows a row's pixels to those whose centres lie on the inner side of the edge from a to b,
/// the inside being where (b − a) × (p − a) is positive.
void clip(Span& span, Corner a, Corner b, std::int64_t y) {
    const Corner way = b - a;
    // Of a pixel x: constant − slope · x.
    const std::int64_t slope = way.y * parts;
    std::int64_t constant = way.x * (y - a.y) - way.y * (parts / 2 - a.x);
    // With y down and the inside as above, an edge that runs up is a left one, and a level one that
    // runs to the right a top one: these hold their own points.
    const bool holdsItsPoints = way.y < 0 || (way.y == 0 && way.x > 0);
    if (!holdsItsPoints) constant -= 1;
    if (slope > 0)
        span.last = std::min(span.last, floorDivide(constant, slope));
    else if (slope < 0)
        span.first = std::max(span.first, ceilDivide(constant, slope));
    else if (constant < 0)
        span.last = span.first - 1;
}

}  // namespace

void coverRows(const FlatGeometry& geometry, const FlatLattice& lattice, int firstRow, int rows,
               std::vector<FlatPixel>& pixels) {
    const shaders::FlatUniforms& u = lattice.uniforms;
    const std::int64_t width = u.pictureSize.x, endRow = firstRow + rows;
    pixels.assign(std::size_t(width) * std::size_t(rows), {});
    const double perRow = u.unitsPerPixel / geometry.unitsPerCircumference();
    const double edge = double(u.lattice.y) + u.phase.y;
    const TriangleRange range = geometry.trianglesWithin((edge - double(endRow) - 1.0) * perRow,
                                                         (edge - double(firstRow) + 1.0) * perRow);
    const auto snapped = [&](double place, int axis) {
        return std::int64_t(u.lattice[axis]) * parts -
               std::int64_t(
                   std::floor((place * u.pixelsPerUnit - u.phase[axis]) * double(parts) + 0.5));
    };
    for (int copy = u.firstCopy; copy < u.firstCopy + lattice.copies; ++copy) {
        const double shift = double(copy) * double(u.unitsPerCircumference);
        for (int t = range.first; t < range.first + range.count; ++t) {
            const glm::ivec3 vertices = geometry.triangles()[std::size_t(t)];
            Corner corners[3];
            for (int c = 0; c < 3; ++c) {
                const glm::ivec4 place = geometry.vertices()[std::size_t(vertices[c])].flatPlace;
                corners[c] = {snapped(double(place.x) + shift, 0), snapped(double(place.y), 1)};
            }
            const auto [lowY, highY] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
            const auto [lowX, highX] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
            const std::int64_t top =
                std::max(ceilDivide(lowY - parts / 2, parts), std::int64_t(firstRow));
            const std::int64_t bottom = std::min(floorDivide(highY - parts / 2, parts), endRow - 1);
            if (top > bottom || highX < 0 || lowX > width * parts) continue;
            const Corner ab = corners[1] - corners[0], ac = corners[2] - corners[0];
            const std::int64_t area = ab.x * ac.y - ab.y * ac.x;
            if (area == 0) continue;
            if (area < 0) std::swap(corners[1], corners[2]);
            for (std::int64_t row = top; row <= bottom; ++row) {
                Span span{0, width - 1};
                const std::int64_t y = row * parts + parts / 2;
                for (int c = 0; c < 3; ++c)
                    clip(span, corners[c], corners[(c + 1) % 3], y);
                for (std::int64_t x = span.first; x <= span.last; ++x)
                    pixels[std::size_t((row - firstRow) * width + x)] = {t, copy};
            }
        }
    }
}

}  // namespace haustra::render
