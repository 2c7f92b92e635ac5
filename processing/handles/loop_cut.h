// Cutting a surface along a loop, and closing both sides.
#pragma once

#include "core/tri_mesh.h"
#include "mesh/halfedge_mesh.h"

namespace haustra::handles {

struct LoopCut {
    TriMesh mesh;
    double filledAreaMm2 = 0.0;   ///< of both discs
    std::size_t firstFilled = 0;  ///< the discs are the triangles from here on
};

/// Slices `mesh` along a loop that visits no vertex twice, draws the two lips apart by a fraction
/// of their triangles' heights, and spans each with a disc (see spanLoop); both discs have the same
/// triangles, so that they lie side by side without touching. Vertices and triangles keep their
/// numbers: the loop's own vertices stay on its left; those of its right and of the discs come
/// after all others. Only the loop's vertices move. `halves` must be HalfedgeMesh::ofClosed(mesh).
LoopCut cutAlong(const TriMesh& mesh, const mesh::HalfedgeMesh& halves, const mesh::Loop& loop);

}  // namespace haustra::handles
