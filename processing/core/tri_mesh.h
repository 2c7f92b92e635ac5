// Triangle meshes in patient space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// Vertices in LPS millimetres; triangles index them, counter-clockwise seen from outside.
struct TriMesh {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::ivec3> triangles;
};

inline double triangleAreaMm2(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    return 0.5 * glm::length(glm::cross(b - a, c - a));
}
/// `triangle`: three of the mesh's vertices, whether one of its triangles or not.
inline double triangleAreaMm2(const TriMesh& mesh, const glm::ivec3& triangle) {
    return triangleAreaMm2(mesh.vertices[std::size_t(triangle.x)],
                           mesh.vertices[std::size_t(triangle.y)],
                           mesh.vertices[std::size_t(triangle.z)]);
}

/// The nearest point whose coordinates are multiples of 2⁻²⁶ mm: less than the rounding of what is
/// hundreds of mm from its origin, so that a mesh that is moved, and moved back, is the same to the
/// last bit. What compares places that are equal in truth needs that.
inline glm::dvec3 onMeshLattice(glm::dvec3 mm) {
    constexpr double perMm = 67108864.0;
    return glm::round(mm * perMm) / perMm;
}

/// What the connectivity alone tells.
struct MeshTopology {
    long eulerCharacteristic = 0;  ///< V − E + F over the vertices that triangles use
    long components = 0;
    long boundaryEdges = 0;     ///< edges of one triangle
    long nonManifoldEdges = 0;  ///< edges of three or more, or of two with the same direction
    bool closed() const { return boundaryEdges == 0 && nonManifoldEdges == 0; }
    /// Sum of the components' genera; meaningful for a closed manifold mesh.
    long genus() const { return (2 * components - eulerCharacteristic) / 2; }
};

/// O(n log n) in the number of triangles. Every index must be within `vertices`.
MeshTopology meshTopology(const TriMesh& mesh);

}  // namespace haustra
