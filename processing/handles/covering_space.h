// A finite portion of a surface's universal covering space.
#pragma once

#include "mesh/cut_graph.h"
#include "mesh/halfedge_mesh.h"

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

}  // namespace haustra::handles
