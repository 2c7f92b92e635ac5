// Two holes in the closed colon, at the rectum and the cecum: what is left is a tube.
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"

#include <vector>

namespace haustra::flatten {

struct EndHoleOptions {
    /// Length of each hole's rim, mm; shorter where the colon is narrower for as far as the hole
    /// may reach, which is rimMm / π along the surface. The map grows as the logarithm of the
    /// hole's size towards it.
    double rimMm = 15.0;
};

struct PunchedTube {
    TriMesh tube;                     ///< two smooth boundary loops
    std::vector<int> sourceTriangle;  ///< per triangle: the one it is, or is a part of
    int firstLoop = -1;               ///< a vertex on the rectum's rim
    double capAreaMm2[2] = {0, 0};    ///< of what was taken away, rectum and cecum
    double rimLengthMm[2] = {0, 0};
};

/// Takes away a small disc of a closed genus-zero surface at each end: around the place that the
/// centerline looks at from its last point (`endsMm`: rectum, cecum; `outwardsMm`: unit directions
/// in which it ends, both LPS), or the vertex nearest to that point where it looks out of the
/// surface or its direction is zero. The rims are level lines of flatten/tube/tip_function.h, cut
/// through the triangles, so that they are smooth loops: corners close to a rim are moved onto it
/// along their edge, and leave no sliver. Everything else of the surface keeps its place. Fails
/// (badInput) where the surface is not closed and of genus zero or the discs would meet. O(n log
/// n).
Result<PunchedTube> punchEnds(const TriMesh& closed, const glm::dvec3 endsMm[2],
                              const glm::dvec3 outwardsMm[2], const EndHoleOptions& options = {});

}  // namespace haustra::flatten
