// Where to slice a closed surface so that it unfolds into one disc.
#pragma once

#include "mesh/halfedge_mesh.h"

#include <vector>

namespace haustra::mesh {

struct CutGraph {
    std::vector<char> cut;    ///< per half-edge: its edge is on the cut graph
    std::vector<Loop> basis;  ///< 2g loops through the root that generate the fundamental group
};

/// The greedy homotopy basis of Erickson and Whittlesey (2005): the shortest-path tree from `root`,
/// the dual tree that crosses the edges of the longest tree loops, and a loop for each of the 2g
/// edges in neither. The cut graph is the union of the loops less their common tails, so that every
/// vertex on it has at least two of its edges, and the surface less the cut graph is one open disc.
/// Empty for a sphere. The mesh must be connected. O(n log n).
CutGraph makeCutGraph(const HalfedgeMesh& mesh, int root);

}  // namespace haustra::mesh
