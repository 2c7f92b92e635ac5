// The true centerline.
#pragma once

#include "phantom/colon_shape.h"

namespace haustra::phantom {

/// The colon's axis, sampled about every millimetre. A sample whose voxel is not lumen is a gap;
/// at the others the radius is the distance to the nearest voxel centre outside the lumen, as in
/// the `distance` product.
Centerline trueCenterline(const ColonShape& shape, const Volume<std::uint8_t>& lumen, int threads);

}  // namespace haustra::phantom
