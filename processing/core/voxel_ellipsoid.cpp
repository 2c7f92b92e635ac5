#include "core/voxel_ellipsoid.h"

#include <algorithm>
#include <cmath>

namespace haustra {
namespace {

struct Moments {
    glm::dvec3 mean;
    glm::dmat3 covariance;
};

// In voxels. A row's own spread is that of its boxes: (count² − 1) / 12 of their centres, and a
// twelfth of each box along each axis.
Moments momentsOf(std::span<const VoxelRun> voxels) {
    double total = 0.0;
    glm::dvec3 sum(0.0);
    const auto center = [](const VoxelRun& run) {
        return glm::dvec3(run.first) + glm::dvec3(0.5 * (run.count - 1), 0.0, 0.0);
    };
    for (const VoxelRun& run : voxels) {
        total += run.count;
        sum += double(run.count) * center(run);
    }
    Moments moments{sum / total, glm::dmat3(1.0 / 12.0)};
    for (const VoxelRun& run : voxels) {
        const double weight = run.count / total;
        const glm::dvec3 off = center(run) - moments.mean;
        moments.covariance += weight * glm::outerProduct(off, off);
        moments.covariance[0][0] += weight * (double(run.count) * run.count - 1.0) / 12.0;
    }
    return moments;
}

// Makes `a` diagonal and gives what it was turned by: its eigenvectors, in columns.
glm::dmat3 diagonalise(glm::dmat3& a) {
    glm::dmat3 turned(1.0);
    for (int sweep = 0; sweep < 32; ++sweep) {
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                if (a[q][p] == 0.0) continue;
                const double angle = 0.5 * std::atan2(2.0 * a[q][p], a[q][q] - a[p][p]);
                glm::dmat3 rotation(1.0);
                rotation[p][p] = rotation[q][q] = std::cos(angle);
                rotation[q][p] = std::sin(angle);
                rotation[p][q] = -std::sin(angle);
                a = glm::transpose(rotation) * a * rotation;
                a[q][p] = a[p][q] = 0.0;
                turned = turned * rotation;
            }
        }
    }
    return turned;
}

// Of a direction and its opposite always the same one.
glm::dvec3 pointedUp(glm::dvec3 v) {
    int largest = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::abs(v[axis]) > std::abs(v[largest]) + 1e-9) largest = axis;
    return v[largest] < 0.0 ? -v : v;
}

}  // namespace

Ellipsoid ellipsoidOf(std::span<const VoxelRun> voxels, const Grid& grid) {
    const Moments moments = momentsOf(voxels);
    const glm::dmat3 toMm(grid.patientFromVoxel);
    glm::dmat3 spread = toMm * moments.covariance * glm::transpose(toMm);
    const glm::dmat3 axes = diagonalise(spread);
    Ellipsoid ellipsoid;
    ellipsoid.centerMm = grid.patientFromVoxelPoint(moments.mean);
    for (int n = 0; n < 3; ++n)
        ellipsoid.halfAxesMm[std::size_t(n)] =
            std::sqrt(5.0 * std::max(spread[n][n], 0.0)) * pointedUp(axes[n]);
    std::ranges::stable_sort(ellipsoid.halfAxesMm, std::ranges::greater{},
                             [](glm::dvec3 axis) { return glm::dot(axis, axis); });
    return ellipsoid;
}

}  // namespace haustra
