#include "cleansing/ball.h"

#include <algorithm>

namespace haustra::cleansing {

glm::ivec3 voxelsIn(const Grid& grid, double mm) {
    return glm::max(glm::ivec3(glm::round(mm / grid.spacingMm())), glm::ivec3(1));
}

glm::ivec3 blurReachVoxels(const Grid& grid) {
    return glm::ivec3(glm::floor(blurReachMm / grid.spacingMm() + 1.5));
}

std::vector<glm::ivec3> ballOffsets(const Grid& grid, glm::dvec3 radiusMm) {
    const glm::ivec3 step = lookStep(grid);
    const glm::dvec3 stepMm = glm::dvec3(step) * grid.spacingMm();
    const glm::ivec3 reach = glm::max(glm::ivec3(glm::floor(radiusMm / stepMm)), glm::ivec3(1));
    std::vector<glm::ivec3> offsets;
    for (int k = -reach.z; k <= reach.z; ++k) {
        for (int j = -reach.y; j <= reach.y; ++j) {
            for (int i = -reach.x; i <= reach.x; ++i) {
                const glm::ivec3 d(i, j, k);
                const bool face = std::abs(i) + std::abs(j) + std::abs(k) == 1;
                if (face ||
                    (d != glm::ivec3(0) && glm::length(glm::dvec3(d) * stepMm / radiusMm) <= 1.0))
                    offsets.push_back(d * step);
            }
        }
    }
    // The farthest first: they are the likeliest to fail.
    std::stable_sort(offsets.begin(), offsets.end(), [](glm::ivec3 a, glm::ivec3 b) {
        return glm::dot(glm::vec3(a), glm::vec3(a)) > glm::dot(glm::vec3(b), glm::vec3(b));
    });
    return offsets;
}

}  // namespace haustra::cleansing
