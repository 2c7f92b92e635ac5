// A finite portion of a surface's universal covering space, and the shortest loops found in it.
#pragma once

#include "mesh/cut_graph.h"
#include "mesh/halfedge_mesh.h"

#include <cstdint>
#include <vector>

namespace haustra::handles {

/// A surface of genus ≥ 1 sliced along its cut graph: a disc whose boundary, counter-clockwise, is
/// a polygon of sides, each a chain of half-edges between two branch points of the cut graph. Every
/// side has a partner that holds the opposite half-edges, in reverse. Corner k is where side k
/// starts.
struct FundamentalDomain {
    std::vector<std::vector<int>> sides;
    std::vector<int> partner;  ///< per side
    std::vector<int> sideOf;   ///< per half-edge of the mesh; −1 where it is not on the cut graph
    std::vector<int> ring;     ///< per corner: how many corners meet at its branch point
    int nextCorner(int side) const;  ///< the corner that follows across `side`, round its start
};

FundamentalDomain slice(const mesh::HalfedgeMesh& mesh, const mesh::CutGraph& graph);

/// Copies of the fundamental domain, glued side to partner as walks cross them (dissertation
/// §3.3.1). Where the copies round a lifted branch point are all there, the ring is closed, so that
/// the portion is always simply connected and covers without branching. A vertex of the mesh is
/// lifted by naming the copy that holds the triangle left of mesh.outgoing(vertex).
/// Keeps references to the mesh and the domain.
class CoveringSpace {
public:
    CoveringSpace(const mesh::HalfedgeMesh& mesh, const FundamentalDomain& domain);

    int copies() const { return int(neighbours_.size() / domain_.sides.size()); }
    /// The copy beyond `side`, or −1 where none is glued yet.
    int neighbour(int copy, int side) const { return neighbours_[slot(copy, side)]; }
    /// The copy beyond `side`, glued now where there is none.
    int across(int copy, int side);
    /// Where the walk along half-edge `h` leads from its origin's lift in `copy`: its target's
    /// lift.
    int along(int copy, int h);

private:
    std::size_t slot(int copy, int side) const {
        return std::size_t(copy) * domain_.sides.size() + std::size_t(side);
    }
    int addCopy();
    void glue(int copy, int side, int other);
    void closeRing(int copy, int corner);

    const mesh::HalfedgeMesh& mesh_;
    const FundamentalDomain& domain_;
    std::vector<int> neighbours_;  // per copy and side
    // Per half-edge: the sides crossed on the way to it around its vertex, from outgoing(vertex)
    // on.
    std::vector<std::vector<int>> turning_;
};

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
