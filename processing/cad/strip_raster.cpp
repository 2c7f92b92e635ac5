#include "cad/strip_raster.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace haustra::cad {

glm::dvec3 StripRaster::placeOf(const Pixel& pixel, const FlatMap& flat) const {
    const glm::ivec3 t = flat.surface.triangles[std::size_t(pixel.triangle)];
    const auto& v = flat.surface.vertices;
    const glm::dvec2 w(pixel.weights);
    return (1.0 - w.x - w.y) * v[std::size_t(t.x)] + w.x * v[std::size_t(t.y)] +
           w.y * v[std::size_t(t.z)];
}

namespace {

// Of the columns from `begin` to before `end`.
void rasterColumns(const FlatMap& flat, int begin, int end, StripRaster& raster) {
    const glm::ivec2 size = raster.size;
    const double columnsPerUnit = size.x / flat.height, rowsPerUnit = size.y;
    for (std::size_t n = 0; n < flat.surface.triangles.size(); ++n) {
        const glm::ivec3 t = flat.surface.triangles[n];
        glm::dvec2 corner[3];
        for (int c = 0; c < 3; ++c) {
            const glm::dvec2 f = flat.flat[std::size_t(t[c])];
            corner[c] = {f.y * columnsPerUnit - 0.5, (1.0 - f.x) * rowsPerUnit - 0.5};
        }
        const glm::dvec2 lo = glm::min(corner[0], glm::min(corner[1], corner[2])),
                         hi = glm::max(corner[0], glm::max(corner[1], corner[2]));
        const int first = std::max(begin, int(std::ceil(lo.x))),
                  last = std::min(end - 1, int(std::floor(hi.x)));
        if (first > last) continue;
        const glm::dvec2 u = corner[1] - corner[0], v = corner[2] - corner[0];
        const double det = u.x * v.y - u.y * v.x;
        if (!(std::abs(det) > 1e-30)) continue;
        // What lies beyond one side of the seam is on the other.
        for (int row = int(std::ceil(lo.y)); row <= int(std::floor(hi.y)); ++row) {
            const int wrapped = ((row % size.y) + size.y) % size.y;
            for (int column = first; column <= last; ++column) {
                const glm::dvec2 off = glm::dvec2(column, row) - corner[0];
                const double a = (off.x * v.y - off.y * v.x) / det,
                             b = (u.x * off.y - u.y * off.x) / det;
                if (a < -1e-9 || b < -1e-9 || a + b > 1.0 + 1e-9) continue;
                raster.pixels[std::size_t(wrapped) * std::size_t(size.x) + std::size_t(column)] = {
                    std::int32_t(n), {float(a), float(b)}};
            }
        }
    }
}

}  // namespace

StripRaster rasterStrip(const FlatMap& flat, glm::ivec2 size, int threads) {
    StripRaster raster{size,
                       std::vector<StripRaster::Pixel>(std::size_t(size.x) * std::size_t(size.y))};
    const std::size_t columns = std::size_t(size.x), bands = std::size_t(threadCount(threads));
    parallelFor(columns, (columns + bands - 1) / bands, threads,
                [&](std::size_t begin, std::size_t end) {
                    rasterColumns(flat, int(begin), int(end), raster);
                });
    return raster;
}

}  // namespace haustra::cad
