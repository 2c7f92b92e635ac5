// From a tube to its flat map: the map, the seam and the cut, and how good they are.
#pragma once

#include "core/flat_map.h"
#include "core/parallel.h"
#include "core/result.h"
#include "flatten/distortion.h"
#include "flatten/tube/conformal_tube.h"
#include "flatten/tube/seam.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace haustra::flatten {

struct FlatteningOptions {
    SeamOptions seam;
    double areaWeight = 0.0;  ///< above 0 the conformal map is followed by unifiedFlattening
    /// Names a place of the surface in an error; empty: by its coordinates.
    std::function<std::string(const glm::dvec3&)> placeName;
    int threads = 0;
    Progress progress;
};

struct Flattening {
    FlatMap map;  ///< without cameras, and without a fold; its sourceTriangle are the tube's
    double modulus = 0.0, certificate = 0.0;
    Distortion distortion;      ///< of the tube's triangles, before the seam splits some; pouches'
                                ///< triangles as they were cut
    Distortion conformal;       ///< before areaWeight took effect; the same where it did not
    double areaWeight = 0.0;    ///< that took effect: 0 where the conformal map had to do
    double seam = 0.0;          ///< the x of the uncut map that the seam lies at
    double seamMismatch = 0.0;  ///< seamMismatch(map)
    int repaired = 0;           ///< vertices
    std::size_t pouches = 0;    ///< blind fingers that were mapped apart (pouches.h)
    double pouchAreaMm2 = 0.0, wallAreaMm2 = 0.0;  ///< of all triangles on the tube
    double largestPouchMm2 = 0.0;
    double largestPouchY = 0.0;  ///< where its border lies on the strip
    /// How many triangles were mapped apart, as often as they were, in the try that succeeded: at
    /// most six for each of the tube's, and 20,000, in the first.
    std::size_t pouchWork = 0;
    std::vector<char> isPouch;  ///< per triangle of `map`; empty where there are none
    /// `distortion` of all but the pouches, whose angles are not kept; the same where there are
    /// none.
    Distortion outside;
};

/// conformalTube; where that leaves blind fingers no room, findPouches and setIn; repairMap;
/// unifiedFlattening where it is asked for; bestSeam, cutAlongSeam, measureDistortion. `firstLoop`:
/// a vertex on the loop that becomes y = 0, or −1. A map is given only if all its triangles are
/// upright on the lattice that it is drawn on (foldedTriangles): discs around those that are not
/// are mapped apart too, and the seam moves by a hair where it leaves splinters; where that is not
/// enough, all over again with grids of any size. Where weighting
/// areas fails or folds, or a large pouch is on a grid, the conformal map is given, with an
/// areaWeight of 0. Fails (noResult)
/// where folds remain, telling how many and the place of one, and as the functions named do. A tube
/// without pouches has the very map of conformalTube.
Result<Flattening> flattenTube(const TriMesh& tube, int firstLoop,
                               const FlatteningOptions& options = {});

/// The triangles whose corners, rounded to whole numbers of 1 / flatUnitsPerCircumference, are not
/// counter-clockwise: turned over, or without area. Exact. O(n).
std::vector<int> foldedTriangles(const FlatMap& map);

/// Along the seam, the largest difference between the two sides, in circumferences: vertices of the
/// sides are paired by their place on the surface, and one without a partner counts as 1. O(n).
double seamMismatch(const FlatMap& map);

}  // namespace haustra::flatten
