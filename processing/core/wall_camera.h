// The endoscopic view of a place on the flattened wall.
#pragma once

#include "core/centerline.h"
#include "core/flat_lookup.h"

namespace haustra {

/// Stands where the flat map registers `place` with the centerline (dissertation §4.3.1), and looks
/// at a point, which is the place itself or one near it, with the colon's direction towards the
/// cecum up: what is above the place in the flat picture and to the right of it is so in this
/// camera's. `place` is one of the map's. O(log n).
CenterlineCamera cameraTowards(const FlatMap& map, const WallPlace& place, glm::dvec3 pointMm);

}  // namespace haustra
