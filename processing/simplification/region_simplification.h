// Simplification inside one box of space.
#pragma once

#include "simplification/regions.h"

namespace haustra::simplification {

/// Collapses edges in the order of their quadric error and then betters the sharpest corners, both
/// among the vertices whose triangles all lie in the region's box. Contacts of the surface with
/// itself are so few that it is cheaper to look for them when all is done, and where there are
/// some, to begin again with a guard about them. Different regions of one partition may be
/// simplified at once, each by one thread.
void simplifyRegion(Simplification& shared, const Region& region);

}  // namespace haustra::simplification
