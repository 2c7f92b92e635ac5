#include "flatten/general/double_cover.h"

#include <utility>

namespace haustra::flatten {

int mirrored(int h, int count) {
    // Corners 1 0 2: the sides 0, 1 and 2 become 0, 2 and 1.
    return count + h - h % 3 + (3 - h % 3) % 3;
}

Result<DoubleCover> doubleCover(const TriMesh& open) {
    const auto surface = TRY(mesh::HalfedgeMesh::of(open));
    if (surface.closed()) {
        return fail(ErrorKind::badInput,
                    "the surface is closed: a double cover is made of one with a boundary");
    }
    const int count = surface.halfedgeCount();
    DoubleCover made;
    made.mesh = open;
    std::vector<int> copyOf(open.vertices.size());
    for (int v = 0; v < int(copyOf.size()); ++v)
        copyOf[std::size_t(v)] = v;
    made.vertexOfCopy = copyOf;
    std::vector<char> onBoundary(open.vertices.size(), 0);
    for (int h = 0; h < count; ++h) {
        if (surface.opposite(h) < 0) onBoundary[std::size_t(surface.origin(h))] = 1;
    }
    for (int v = 0; v < int(copyOf.size()); ++v) {
        if (onBoundary[std::size_t(v)] || surface.outgoing(v) < 0) continue;
        copyOf[std::size_t(v)] = int(made.mesh.vertices.size());
        made.mesh.vertices.push_back(open.vertices[std::size_t(v)]);
        made.vertexOfCopy.push_back(v);
    }
    for (const glm::ivec3& t : open.triangles) {
        made.mesh.triangles.push_back(
            {copyOf[std::size_t(t.y)], copyOf[std::size_t(t.x)], copyOf[std::size_t(t.z)]});
    }
    std::vector<int> opposite(std::size_t(2 * count));
    std::vector<double> lengthMm(std::size_t(2 * count));
    for (int h = 0; h < count; ++h) {
        const int other = surface.opposite(h), twin = mirrored(h, count);
        opposite[std::size_t(h)] = other < 0 ? twin : other;
        opposite[std::size_t(twin)] = other < 0 ? h : mirrored(other, count);
        lengthMm[std::size_t(h)] = lengthMm[std::size_t(twin)] = surface.lengthMm(h);
    }
    auto glued = TRY(mesh::HalfedgeMesh::glued(int(made.mesh.vertices.size()), made.mesh.triangles,
                                               std::move(opposite), std::move(lengthMm)));
    made.halfedges = std::move(glued);
    return made;
}

}  // namespace haustra::flatten
