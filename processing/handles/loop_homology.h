// Which loops separate a closed surface.
#pragma once

#include "mesh/halfedge_mesh.h"

#include <cstdint>
#include <vector>

namespace haustra::handles {

/// For each half-edge, which of 2g closed dual curves it crosses, one bit each; both directions of
/// an edge have the same marks. The curves generate the first homology over Z₂, so that the marks
/// of a loop's edges add up (exclusive or) to zero if and only if cutting along a simple loop of
/// its class would split the surface. From genus 33 on the curves share bits by a fixed hash: then
/// a non-zero sum is still proof, and a zero sum wrong with a chance of 2⁻⁶⁴. Breadth-first dual
/// tree and the primal forest that it leaves (tree-cotree), so that the curves are short and
/// straight. The mesh must be connected. O(n).
std::vector<std::uint64_t> homologyMarks(const mesh::HalfedgeMesh& mesh);

}  // namespace haustra::handles
