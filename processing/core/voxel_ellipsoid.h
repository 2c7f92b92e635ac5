// A blob of voxels as the ellipsoid that is most like it.
#pragma once

#include "core/findings.h"
#include "core/grid.h"

#include <array>
#include <span>

#include <glm/glm.hpp>

namespace haustra {

struct Ellipsoid {
    glm::dvec3 centerMm{0.0};
    std::array<glm::dvec3, 3> halfAxesMm{};  ///< orthogonal, the longest first
};

/// The solid ellipsoid that has the voxels' centre and second moments, where each voxel counts with
/// its whole body: of a single voxel that is a box, half-axes √(5/12) of its sides. For a solid
/// ellipsoid of half-axis a the variance along it is a²/5. The axes are the covariance's
/// eigenvectors, by Jacobi's rotations, each with its largest component positive. `voxels` holds
/// one run at least, of `grid`. Linear in the runs.
Ellipsoid ellipsoidOf(std::span<const VoxelRun> voxels, const Grid& grid);

}  // namespace haustra
