// Where the tube is cut open.
#pragma once

#include "core/flat_map.h"
#include "flatten/periodic_map.h"

namespace haustra::flatten {

struct SeamOptions {
    std::vector<glm::dvec3> keepAwayMm;  ///< CAD candidates, bookmarks …
    double keepAwayRadiusMm = 15.0;
};

/// The x of the vertical trajectory that does the least harm: along it the surface bends least
/// (curvature measured over a margin to both sides, in millimetres along the trajectory), and no
/// place of `keepAwayMm` is near.
double bestSeam(const TriMesh& tube, const PeriodicMap& map, const SeamOptions& options = {});

/// The tube cut along x = `seam`: triangles that it crosses are split, vertices on it doubled, and
/// x counts from it. The result has no cameras yet; its sourceTriangle are the tube's. The two
/// sides of the seam have the same 3-D places and y bit for bit, and x of 0 and 1.
FlatMap cutAlongSeam(const TriMesh& tube, PeriodicMap map, double seam);

}  // namespace haustra::flatten
