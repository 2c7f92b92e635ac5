#include "cleansing/ball.h"

#include <algorithm>

namespace haustra::cleansing {

std::vector<glm::ivec3> ballOffsets(const Grid& grid, double radiusMm) {
    const glm::dvec3 spacing = grid.spacingMm();
    const glm::ivec3 reach = glm::max(glm::ivec3(glm::floor(radiusMm / spacing)), glm::ivec3(1));
    std::vector<glm::ivec3> offsets;
    for (int k = -reach.z; k <= reach.z; ++k) {
        for (int j = -reach.y; j <= reach.y; ++j) {
            for (int i = -reach.x; i <= reach.x; ++i) {
                const glm::ivec3 d(i, j, k);
                const bool face = std::abs(i) + std::abs(j) + std::abs(k) == 1;
                if (face ||
                    (d != glm::ivec3(0) && glm::length(glm::dvec3(d) * spacing) <= radiusMm))
                    offsets.push_back(d);
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
