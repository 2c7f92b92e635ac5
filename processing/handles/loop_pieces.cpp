#include "handles/loop_pieces.h"

#include <utility>

namespace haustra::handles {

std::vector<Piece> piecesOf(const mesh::HalfedgeMesh& halves, const TriMesh& mesh) {
    std::vector<Piece> pieces;
    std::vector<int> pieceOf(mesh.triangles.size(), -1), number(mesh.vertices.size(), -1), stack;
    for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed) {
        if (pieceOf[seed] >= 0) continue;
        pieceOf[seed] = int(pieces.size());
        pieces.emplace_back();
        stack.push_back(int(seed));
        while (!stack.empty()) {
            const int t = stack.back();
            stack.pop_back();
            for (int corner = 0; corner < 3; ++corner) {
                const int next = halves.opposite(3 * t + corner) / 3;
                if (pieceOf[next] >= 0) continue;
                pieceOf[next] = pieceOf[t];
                stack.push_back(next);
            }
        }
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Piece& piece = pieces[std::size_t(pieceOf[t])];
        glm::ivec3 triangle = mesh.triangles[t];
        for (int corner = 0; corner < 3; ++corner) {
            int& v = number[triangle[corner]];
            if (v < 0) {
                v = int(piece.vertices.size());
                piece.vertices.push_back(triangle[corner]);
                piece.mesh.vertices.push_back(mesh.vertices[triangle[corner]]);
            }
            triangle[corner] = v;
        }
        piece.triangles.push_back(t);
        piece.mesh.triangles.push_back(triangle);
    }
    return pieces;
}

void putBack(TriMesh& whole, Piece piece) {
    for (std::size_t v = piece.vertices.size(); v < piece.mesh.vertices.size(); ++v) {
        piece.vertices.push_back(int(whole.vertices.size()));
        whole.vertices.emplace_back();
    }
    for (std::size_t v = 0; v < piece.vertices.size(); ++v)
        whole.vertices[std::size_t(piece.vertices[v])] = piece.mesh.vertices[v];
    for (std::size_t t = 0; t < piece.mesh.triangles.size(); ++t) {
        glm::ivec3 triangle = piece.mesh.triangles[t];
        for (int corner = 0; corner < 3; ++corner)
            triangle[corner] = piece.vertices[std::size_t(triangle[corner])];
        if (t < piece.triangles.size()) {
            whole.triangles[piece.triangles[t]] = triangle;
        } else {
            whole.triangles.push_back(triangle);
        }
    }
}

}  // namespace haustra::handles
