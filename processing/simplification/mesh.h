// The triangles that simplification works on: a corner table whose operations are local.
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"

#include <vector>

namespace haustra::simplification {

/// A closed manifold mesh as a corner table (Rossignac 2001): corner c = 3 t + k is triangle t's
/// k-th; opposite[c] is the corner across the edge that faces c. Two arrays hold the connectivity,
/// and an operation touches only the stars of its vertices, so that regions of space can be worked
/// on at once. Removed triangles keep their slots, with vertex −1.
///
/// Own arrays rather than OpenMesh's decimater, whose modules see neither the surface beside a
/// collapse nor the way back from the output to the input, and whose one queue is one thread's.
struct CornerMesh {
    std::vector<glm::dvec3> position;
    std::vector<int> cornerOf;  ///< of a vertex: one of its corners, −1 for a removed vertex
    std::vector<int> valence;
    std::vector<int> vertex;    ///< of a corner
    std::vector<int> opposite;  ///< of a corner

    int triangleCount() const { return int(vertex.size() / 3); }
    bool alive(int triangle) const { return vertex[3 * triangle] >= 0; }

    static int next(int corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    static int previous(int corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
    /// The corner at the same vertex, of the next triangle counter-clockwise. By pointer: the
    /// innermost step of all that simplification does.
    int turned(int corner) const { return next(opposite.data()[next(corner)]); }

    /// Calls visit(corner) for the corners at `v`, counter-clockwise.
    template <class Visit>
    void aroundVertex(int v, const Visit& visit) const {
        const int first = cornerOf[v];
        int corner = first;
        do {
            visit(corner);
            corner = turned(corner);
        } while (corner != first);
    }

    /// The corner at `a` of the triangle that has the directed edge a → b, or −1.
    int cornerOfEdge(int a, int b) const;

    /// Joins vertex b = the next of `cornerAtA` into a = its vertex; removes the two triangles at
    /// the edge. The link condition must hold. O(valence).
    void collapse(int cornerAtA);

    /// Turns the edge that faces `corner` within its two triangles, which keep their slots. The new
    /// edge must not be there already. O(1).
    void flip(int corner);

private:
    void join(int cornerA, int cornerB);
};

/// The mesh's corner table, vertices that no triangle uses having cornerOf −1. Fails (badInput)
/// where the mesh is not closed, not manifold, or two fans share one vertex. O(n log n).
Result<CornerMesh> cornerMesh(const TriMesh& mesh);

/// The triangles and the vertices they use, in their order.
TriMesh triMesh(const CornerMesh& mesh);

}  // namespace haustra::simplification
