// Whether the surface in a region cuts through itself.
#pragma once

#include "simplification/mesh.h"
#include "simplification/triangle_grid.h"
#include "simplification/triangle_separation.h"

#include <array>
#include <span>
#include <vector>

namespace haustra::simplification {

/// A patch of triangles and what shall take its place.
struct Replacement {
    std::vector<int> oldTriangles;
    std::vector<int> newTriangles;            ///< one each of the old
    std::vector<std::array<int, 3>> corners;  ///< of the new triangles
    int moved = -1;                           ///< the vertex that moves to `place`
    glm::dvec3 place{0.0};

    const glm::dvec3& placeOf(const CornerMesh& mesh, int v) const {
        return v == moved ? place : mesh.position[v];
    }
};

struct NamedTriangle {
    std::array<int, 3> vertex;
    TriangleCorners place;
};

/// Refuses replacements that would meet the surface other than at common vertices and edges,
/// within some boxes of space. Of one thread.
class ContactGuard {
public:
    ContactGuard(const CornerMesh& mesh, std::span<const FloatBox> guarded);

    /// Whether the new triangles meet one another or, in a guarded box, others of the mesh.
    bool refuses(const Replacement& replacement);
    /// Forgets the old triangles; call it before they change.
    void remove(const Replacement& replacement);
    /// Takes in the new triangles; call it when they are in the mesh.
    void insert(const Replacement& replacement);

private:
    bool guards(const FloatBox& box) const;

    const CornerMesh& mesh_;
    std::span<const FloatBox> guarded_;
    TriangleGrid grid_;
    std::vector<NamedTriangle> triangles_;
    std::vector<FloatBox> boxes_;
    std::vector<SeparatingPlanes> planes_;
};

/// A box around each pair of triangles, one of which `changed` (of a triangle), that meet other
/// than at common vertices and edges, or too nearly do to tell. O(triangles).
std::vector<FloatBox> contacts(const CornerMesh& mesh, const std::vector<char>& changed);

}  // namespace haustra::simplification
