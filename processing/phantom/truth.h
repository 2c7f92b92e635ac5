// What is true of a colon by its shape: the centerline, the polyps' tissue.
#pragma once

#include "phantom/colon_shape.h"

namespace haustra::phantom {

/// The colon's axis, sampled about every millimetre. A sample whose voxel is not lumen is a gap;
/// at the others the radius is the distance to the nearest voxel centre outside the lumen, as in
/// the `distance` product.
Centerline trueCenterline(const ColonShape& shape, const Volume<std::uint8_t>& lumen, int threads);

/// Of each of polypsOf(shape) in turn: indices of the voxels whose centres lie in the polyp and
/// would lie in the lumen without it, ascending.
std::vector<std::vector<std::uint32_t>> polypVoxels(const ColonShape& shape, const Grid& grid);

}  // namespace haustra::phantom
