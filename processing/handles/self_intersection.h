// Where a surface cuts through itself.
#pragma once

#include "core/tri_mesh.h"

#include <utility>
#include <vector>

namespace haustra::handles {

/// Pairs of triangles (sorted, the lower first) that share more than what their common vertices
/// make them share, and (n, n) for a triangle without area. Exact (CGAL's predicates and box
/// intersection; on a manifold mesh what its Polygon_mesh_processing::self_intersections finds),
/// for any mesh whose indices are within `vertices`. O(n log³ n), one thread; thread-safe.
std::vector<std::pair<int, int>> selfIntersections(const TriMesh& mesh);

}  // namespace haustra::handles
