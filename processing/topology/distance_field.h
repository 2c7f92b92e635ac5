// Exact Euclidean distance in a mask.
#pragma once

#include "core/volume.h"

#include <cstdint>

namespace haustra::topology {

/// For each voxel with a label other than 0, the distance in mm from its centre to the nearest
/// centre of a voxel with label 0 (voxels beyond the grid do not count); 0 for the others.
/// Infinity everywhere inside if no voxel has label 0. Exact up to float rounding for any
/// anisotropic spacing along the grid's axes, which must be orthogonal; the same bytes for any
/// number of threads (≤ 0: all cores).
///
/// One axis after the other, each by the lower envelope of parabolas (Felzenszwalb and
/// Huttenlocher, Distance Transforms of Sampled Functions, 2012; Meijster et al. 2000). Linear:
/// one read of the labels, then work on the voxels inside alone, because a run of inside voxels
/// on a line sees nothing past the two outside voxels that bound it. Needs 8 bytes a voxel of one
/// slice for each thread beside the result, of which only rows with lumen are held.
Volume<float> distanceToBoundaryMm(const Volume<std::uint8_t>& labels, int threads = 0);

}  // namespace haustra::topology
