// Loops that generate a closed surface's first homology, and integer forms that count them.
#pragma once

#include "core/result.h"
#include "mesh/halfedge_mesh.h"

#include <cstdint>
#include <vector>

namespace haustra::flatten {

struct HomologyBasis {
    /// 2g closed walks along the cut graph.
    std::vector<mesh::Loop> loops;
    /// Closed integer forms on half-edges, dual to the loops: form k adds up to δ_ik along loop i,
    /// and counts how often a walk crosses the k-th of 2g closed curves through triangles.
    std::vector<std::vector<std::int8_t>> dual;
    /// ∫ form i ∧ form j: skew, integer, of determinant 1.
    std::vector<std::vector<int>> wedge;
};

/// The cut graph of makeCutGraph from the first vertex that a triangle uses: a loop for each of its
/// 2g edges outside a spanning tree of it, and the curve that crosses this edge alone of all the
/// cut graph's and returns through the disc that the cut graph leaves. Empty for a sphere. Fails
/// (badInput) where the mesh is open, empty or not in one piece. O(n log n + g·n).
Result<HomologyBasis> homologyBasis(const mesh::HalfedgeMesh& mesh);

}  // namespace haustra::flatten
