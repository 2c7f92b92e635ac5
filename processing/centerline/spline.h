// The centerline's smooth curve: a B-spline through a voxel path, kept inside the lumen.
#pragma once

#include "core/volume.h"

#include <vector>

namespace haustra::centerline {

/// True where the voxel nearest to a patient point is on the grid and has a label other than 0.
bool insideLumen(const Volume<std::uint8_t>& labels, glm::dvec3 voxel);

/// True where each voxel that the straight way from `a` to `b` (voxel coordinates) passes is inside
/// the lumen. The voxels follow each other face to face, so no way leads through a wall that parts
/// the lumen, were it one voxel thick and oblique.
bool staysInside(const Volume<std::uint8_t>& labels, glm::dvec3 a, glm::dvec3 b);

/// A cubic B-spline fitted to a 26-connected path of inside voxels, as a polyline in patient mm
/// with a few points a voxel. It minimises ∫ |c − path|² / ℓ⁴ + ∫ |c″|², so that bends shorter
/// than ℓ are smoothed away; ℓ is a part of the distance to the boundary and is halved wherever
/// the curve would leave the lumen or lose half of the path's distance from the boundary. Every
/// point returned is inside the lumen. Linear in the path's length.
std::vector<glm::dvec3> smoothInsideLumen(const std::vector<glm::ivec3>& path,
                                          const Volume<std::uint8_t>& labels,
                                          const Volume<float>& distanceMm);

}  // namespace haustra::centerline
