#include "segmentation/body_frame.h"

#include "core/quantile.h"

#include <algorithm>
#include <vector>

namespace haustra::segmentation {

std::vector<glm::vec3> softTissueSamples(const Volume<std::int16_t>& hu,
                                         const Volume<std::uint8_t>& content) {
    constexpr int step = 4;
    constexpr int softFromHu = -20, softToHu = 120;
    const Grid& grid = hu.grid();
    std::vector<glm::vec3> samples;
    for (int k = 0; k < grid.size.z; k += step) {
        for (int j = 0; j < grid.size.y; j += step) {
            for (int i = 0; i < grid.size.x; i += step) {
                const std::size_t n = grid.index(i, j, k);
                if (Content(content[n]) != Content::tissue || hu[n] < softFromHu ||
                    hu[n] > softToHu)
                    continue;
                samples.emplace_back(grid.patientFromVoxelPoint({i, j, k}));
            }
        }
    }
    return samples;
}

BodyFrame findBodyFrame(std::span<const glm::vec3> softTissueMm, double lowMm, double highMm) {
    std::vector<double> x, y;
    for (const glm::dvec3 p : softTissueMm) {
        if (p.z < lowMm || p.z > highMm) continue;
        x.push_back(p.x), y.push_back(p.y);
    }
    BodyFrame frame;
    frame.lowMm = lowMm, frame.highMm = std::max(highMm, lowMm + 1.0);
    if (x.size() < 100) return frame;
    const double left = quantileOf(x, 0.02), right = quantileOf(x, 0.98);
    const double front = quantileOf(y, 0.02), back = quantileOf(y, 0.98);
    frame.middleMm = {0.5 * (left + right), 0.5 * (front + back), 0.5 * (lowMm + highMm)};
    frame.halfMm = {std::max(1.0, 0.5 * (right - left)), std::max(1.0, 0.5 * (back - front))};
    return frame;
}

}  // namespace haustra::segmentation
