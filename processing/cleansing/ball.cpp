#include "cleansing/ball.h"

#include <algorithm>
#include <cstdlib>

namespace haustra::cleansing {

glm::ivec3 voxelsIn(const Grid& grid, double mm) {
    return glm::max(glm::ivec3(glm::round(mm / grid.spacingMm())), glm::ivec3(1));
}

glm::ivec3 blurReachVoxels(const Grid& grid) {
    return glm::ivec3(glm::floor(blurReachMm / grid.spacingMm() + 1.5));
}

Ball::Ball(const Grid& grid, glm::dvec3 radiusMm) : grid_(grid) {
    const glm::ivec3 look = neighbourStep(grid);
    const glm::dvec3 lookMm = glm::dvec3(look) * grid.spacingMm();
    const glm::ivec3 reach = glm::max(glm::ivec3(glm::floor(radiusMm / lookMm)), glm::ivec3(1));
    const std::ptrdiff_t row = grid.size.x, slice = row * grid.size.y;
    for (int k = -reach.z; k <= reach.z; ++k) {
        for (int j = -reach.y; j <= reach.y; ++j) {
            for (int i = -reach.x; i <= reach.x; ++i) {
                const glm::ivec3 d(i, j, k), v = d * look;
                const bool face = std::abs(i) + std::abs(j) + std::abs(k) == 1;
                if (face ||
                    (d != glm::ivec3(0) && glm::length(glm::dvec3(d) * lookMm / radiusMm) <= 1.0))
                    steps_.push_back({v, v.x + row * v.y + slice * v.z});
            }
        }
    }
    reach_ = reach * look;
    std::stable_sort(steps_.begin(), steps_.end(), [](const Step& a, const Step& b) {
        return glm::dot(glm::vec3(a.voxels), glm::vec3(a.voxels)) >
               glm::dot(glm::vec3(b.voxels), glm::vec3(b.voxels));
    });
}

}  // namespace haustra::cleansing
