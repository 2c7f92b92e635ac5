#include "dicom/slice_resampling.h"

#include "core/parallel.h"
#include "dicom/stored_values.h"

#include <algorithm>
#include <cmath>

namespace haustra::dicom {

void placeShifted(std::span<const std::int16_t> slice, glm::ivec2 matrix, glm::dvec2 shift,
                  std::span<std::int16_t> result, glm::ivec2 size) {
    std::fill(result.begin(), result.end(), paddingHu);
    const glm::ivec2 whole(glm::ceil(shift));
    const glm::dvec2 fraction = glm::dvec2(whole) - shift;  // towards the next pixel of the slice
    const int nextX = fraction.x > 0.0 ? 1 : 0;
    const int nextY = fraction.y > 0.0 ? 1 : 0;
    const int lastX = std::min(matrix.x - nextX, size.x - whole.x);
    const int lastY = std::min(matrix.y - nextY, size.y - whole.y);
    for (int y = 0; y < lastY; ++y) {
        const std::int16_t* row = slice.data() + std::size_t(y) * std::size_t(matrix.x);
        const std::int16_t* below = row + std::size_t(nextY) * std::size_t(matrix.x);
        std::int16_t* out =
            result.data() + std::size_t(y + whole.y) * std::size_t(size.x) + whole.x;
        for (int x = 0; x < lastX; ++x) {
            const double here = row[x] + fraction.x * (row[x + nextX] - row[x]);
            const double there = below[x] + fraction.x * (below[x + nextX] - below[x]);
            out[x] = std::int16_t(std::lround(here + fraction.y * (there - here)));
        }
    }
}

Volume<std::int16_t> resampleDepth(const Volume<std::int16_t>& slices,
                                   const std::vector<double>& depthSlices, const Grid& grid,
                                   int threads) {
    Volume<std::int16_t> result(grid);
    const std::size_t plane = std::size_t(grid.size.x) * std::size_t(grid.size.y);
    const std::span<std::int16_t> out = result.writable();
    const std::span<const std::int16_t> in = slices.voxels();
    parallelFor(std::size_t(grid.size.z), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto above = std::upper_bound(depthSlices.begin(), depthSlices.end(), double(k));
            const std::size_t hi = std::min<std::size_t>(std::size_t(above - depthSlices.begin()),
                                                         depthSlices.size() - 1);
            const std::size_t lo = hi == 0 ? 0 : hi - 1;
            const double apart = depthSlices[hi] - depthSlices[lo];
            const double along =
                apart > 0.0 ? std::clamp((double(k) - depthSlices[lo]) / apart, 0.0, 1.0) : 0.0;
            for (std::size_t n = 0; n < plane; ++n) {
                const int a = in[lo * plane + n], b = in[hi * plane + n];
                out[k * plane + n] = std::int16_t(std::lround(a + along * (b - a)));
            }
        }
    });
    return result;
}

}  // namespace haustra::dicom
