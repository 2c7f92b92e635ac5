// Exact Euclidean distance in a mask.
#pragma once

#include <cstdint>

#include "core/volume.h"

namespace haustra::topology {

/// For each voxel with a label other than 0, the distance in mm from its centre to the nearest
/// centre of a voxel with label 0 (voxels beyond the grid do not count); 0 for the others.
/// Infinity everywhere inside if no voxel has label 0. Exact for any anisotropic spacing
/// along the grid's axes, linear in the number of voxels, the same for any number of threads.
Volume<float> distanceToBoundaryMm(const Volume<std::uint8_t>& labels, int threads = 0);

}  // namespace haustra::topology
