// Where a surface cuts through itself.
#pragma once

#include "core/tri_mesh.h"

#include <utility>
#include <vector>

namespace haustra::surface {

/// Pairs of triangles (sorted) that share more than what their common vertices make them share;
/// exact (CGAL's self_intersections). O(n log n).
std::vector<std::pair<int, int>> selfIntersections(const TriMesh& mesh);

}  // namespace haustra::surface
