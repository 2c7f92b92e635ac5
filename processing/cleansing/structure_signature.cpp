#include "cleansing/structure_signature.h"

#include "cleansing/ball.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haustra::cleansing {
namespace {

/// Of a symmetric matrix (Smith 1961).
double largestEigenvalue(const glm::dmat3& m) {
    const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
    const glm::dmat3 rest = m - glm::dmat3(mean);
    double squares = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        squares += glm::dot(rest[axis], rest[axis]);
    const double p = std::sqrt(squares / 6.0);
    if (p < 1e-9) return mean;
    const double cosine = std::clamp(glm::determinant(rest) / (2.0 * p * p * p), -1.0, 1.0);
    return mean + 2.0 * p * std::cos(std::acos(cosine) / 3.0);
}

}  // namespace

double structureSignature(const Volume<std::int16_t>& hu, glm::ivec3 voxel, double noiseSd) {
    const Grid& grid = hu.grid();
    const glm::ivec3 look = neighbourStep(grid);
    if (!grid.contains(voxel - look) || !grid.contains(voxel + look)) return 0.0;
    // In standard deviations of a second difference, so that each axis counts by its own noise.
    glm::dmat3 hessian;
    for (int a = 0; a < 3; ++a) {
        glm::ivec3 u(0);
        u[a] = look[a];
        hessian[a][a] = hu.at(voxel + u) - 2.0 * hu.at(voxel) + hu.at(voxel - u);
        for (int b = 0; b < a; ++b) {
            glm::ivec3 w(0);
            w[b] = look[b];
            hessian[a][b] = hessian[b][a] = 0.25 * (hu.at(voxel + u + w) - hu.at(voxel + u - w) -
                                                    hu.at(voxel - u + w) + hu.at(voxel - u - w));
        }
    }
    const double bend = largestEigenvalue(hessian) / (std::sqrt(6.0) * noiseSd);
    return std::clamp((bend - 2.5) / 1.5, 0.0, 1.0);
}

}  // namespace haustra::cleansing
