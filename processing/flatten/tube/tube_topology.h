// What a tube's connectivity alone tells: its two rims, and where one turn around it ends.
#pragma once

#include "core/result.h"
#include "mesh/halfedge_mesh.h"

#include <cstdint>
#include <vector>

namespace haustra::flatten {

struct TubeTopology {
    std::vector<int> rims[2];  ///< the boundary loops' vertices, in order along them
    /// The vertices that triangles use, breadth first from the first rim.
    std::vector<int> breadthFirst;
    /// Level n, the vertices n edges away, is breadthFirst[levelStart[n]] … [levelStart[n + 1] −
    /// 1].
    std::vector<int> levelStart;
    /// Per half-edge 3·triangle + corner: 1 where that corner lies on the cut and the triangle to
    /// the left of it, else 0. The cut is a shortest path of edges from rim to rim; a corner's
    /// value counts the turns between its vertex and the triangle, the tube being cut open there.
    std::vector<std::int8_t> cornerTurns;
};

/// `firstRim` is a vertex of the rim that comes first (−1: the one with the lowest-numbered
/// vertex). Fails (badInput) where the mesh is not one piece of genus 0 with two boundary loops, or
/// `firstRim` is on neither. O(n).
Result<TubeTopology> tubeTopology(const mesh::HalfedgeMesh& mesh, int firstRim);

}  // namespace haustra::flatten
