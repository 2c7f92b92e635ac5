// From a tube to its flat map: the map, the seam and the cut, and how good they are.
#pragma once

#include "core/flat_map.h"
#include "core/parallel.h"
#include "core/result.h"
#include "flatten/conformal_tube.h"
#include "flatten/distortion.h"
#include "flatten/seam.h"

#include <cstddef>

namespace haustra::flatten {

struct FlatteningOptions {
    SeamOptions seam;
    double areaWeight = 0.0;  ///< above 0 the conformal map is followed by unifiedFlattening
    int threads = 0;
    Progress progress;
};

struct Flattening {
    FlatMap map;  ///< without cameras; its sourceTriangle are the tube's
    double modulus = 0.0, certificate = 0.0;
    Distortion distortion;      ///< of the tube's own triangles, before the seam splits some
    Distortion conformal;       ///< before areaWeight took effect; the same where it is 0
    std::size_t flips = 0;      ///< among the triangles of `map`
    double seam = 0.0;          ///< the x of the uncut map that the seam lies at
    double seamMismatch = 0.0;  ///< seamMismatch(map)
    int repaired = 0;           ///< vertices
};

/// conformalTube, unifiedFlattening where it is asked for, bestSeam, cutAlongSeam,
/// measureDistortion. `firstLoop`: a vertex on the loop that becomes y = 0, or −1. Fails as these
/// do.
Result<Flattening> flattenTube(const TriMesh& tube, int firstLoop,
                               const FlatteningOptions& options = {});

/// Along the seam, the largest difference between the two sides, in circumferences: vertices of the
/// sides are paired by their place on the surface, and one without a partner counts as 1. O(n).
double seamMismatch(const FlatMap& map);

}  // namespace haustra::flatten
