// A closed surface from an open one (dissertation §4.2.2.1).
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"
#include "mesh/halfedge_mesh.h"

#include <vector>

namespace haustra::flatten {

/// Two copies of an open surface glued along its whole boundary; of a tube, a torus. Triangle
/// t + n of the second copy is triangle t turned over: t's corners 1, 0, 2. Boundary vertices are
/// shared.
struct DoubleCover {
    TriMesh mesh;
    /// The gluing, which the triangles' corners do not tell where an edge joins two vertices of the
    /// boundary: then both copies' edges join them.
    mesh::HalfedgeMesh halfedges;
    std::vector<int> vertexOfCopy;  ///< per vertex of `mesh`: the surface's
};

/// Half-edge of the second copy for half-edge h of `count` half-edges of the surface: of the same
/// edge, in the other direction.
int mirrored(int h, int count);

/// Fails (badInput) where the mesh is closed or not manifold. O(n).
Result<DoubleCover> doubleCover(const TriMesh& open);

}  // namespace haustra::flatten
