// A wall whose triangles are small enough to count as seen once a ray meets them.
#pragma once

#include "core/tri_mesh.h"

#include <cstdint>
#include <vector>

namespace haustra::coverage {

/// Edges of this length bound triangles at √3/4 · 1.5² = 0.97 mm²: "all triangles are very small
/// (triangle area < 1 mm²)" is why the dissertation (§2.3) may count one as observed when at least
/// one ray meets it. A simplified surface has triangles ten times as large.
inline constexpr double mostEdgeMm = 1.5;

/// The same wall, to the last point, in smaller triangles.
struct FineWall {
    TriMesh mesh;
    std::vector<std::int32_t> sourceTriangle;  ///< per triangle: the one of the wall it is part of
};

/// Halves every edge longer than `mostMm` (over 0), in both of its triangles, until there is none,
/// so that a closed mesh stays closed. Triangles keep their winding and the order of those that
/// they are parts of; vertices of `wall` keep their numbers. O(triangles of the result · log).
FineWall fineWall(const TriMesh& wall, double mostMm = mostEdgeMm);

}  // namespace haustra::coverage
