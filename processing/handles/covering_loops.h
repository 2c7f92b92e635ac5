// The shortest loops of a coarse mesh, found in its universal covering space.
#pragma once

#include "mesh/halfedge_mesh.h"

#include <cstdint>
#include <vector>

namespace haustra::handles {

/// For each vertex of the cut graph, which every loop that does not separate must meet, the
/// shortest such loop through it: the shortest path from a lift of the vertex to another, in a
/// portion of the universal covering space whose copies are glued as the search front reaches them.
/// A loop may end in another copy and yet separate (the neck between two handles): cutting there
/// would split the surface and remove no handle, so loops whose `marks` (see homologyMarks) add up
/// to zero are passed over. Loops longer than `slack` times the shortest may be missing. Shortest
/// first, with the common tail taken off. Empty for a sphere. O(k n log n) for k cut-graph
/// vertices.
std::vector<mesh::Loop> coveringLoops(const mesh::HalfedgeMesh& mesh,
                                      const std::vector<std::uint64_t>& marks, double slack);

}  // namespace haustra::handles
