// The connected pieces of a mesh, each by itself.
#pragma once

#include "core/tri_mesh.h"
#include "mesh/halfedge_mesh.h"

#include <vector>

namespace haustra::handles {

/// One connected piece, and where its vertices and triangles are in the whole.
struct Piece {
    TriMesh mesh;
    std::vector<int> vertices;
    std::vector<std::size_t> triangles;
};

/// In the order of their first triangles; vertices that no triangle uses are in none. `halves` must
/// be HalfedgeMesh::ofClosed(mesh). O(n).
std::vector<Piece> piecesOf(const mesh::HalfedgeMesh& halves, const TriMesh& mesh);

/// Puts a changed piece back: what it had keeps its numbers in the whole, what is new comes last.
void putBack(TriMesh& whole, Piece piece);

}  // namespace haustra::handles
