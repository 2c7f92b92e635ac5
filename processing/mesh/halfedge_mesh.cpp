#include "mesh/halfedge_mesh.h"

#include <algorithm>
#include <numeric>

namespace haustra::mesh {
namespace {

bool soundTriangles(const TriMesh& mesh) {
    const int count = int(mesh.vertices.size());
    for (const glm::ivec3& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            if (t[corner] < 0 || t[corner] >= count || t[corner] == t[(corner + 1) % 3])
                return false;
        }
    }
    return true;
}

}  // namespace

Result<HalfedgeMesh> HalfedgeMesh::of(const TriMesh& mesh) {
    if (!soundTriangles(mesh)) {
        return fail(ErrorKind::badInput,
                    "a triangle of the mesh repeats a vertex, or names one that does not exist");
    }
    HalfedgeMesh made;
    const std::size_t halfedges = mesh.triangles.size() * 3;
    made.origin_.resize(halfedges);
    made.opposite_.assign(halfedges, -1);
    made.outgoing_.assign(mesh.vertices.size(), -1);
    made.lengthMm_.resize(halfedges);
    std::vector<int> first(mesh.vertices.size() + 1, 0), leaving(halfedges);
    for (std::size_t h = 0; h < halfedges; ++h) {
        made.origin_[h] = mesh.triangles[h / 3][int(h % 3)];
        ++first[made.origin_[h] + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<int> at(first.begin(), first.end() - 1);
    for (std::size_t h = 0; h < halfedges; ++h)
        leaving[at[made.origin_[h]]++] = int(h);

    for (int h = 0; h < int(halfedges); ++h) {
        const int a = made.origin(h), b = made.target(h);
        made.lengthMm_[h] =
            glm::distance(mesh.vertices[std::min(a, b)], mesh.vertices[std::max(a, b)]);
        int same = 0, back = 0;
        for (int i = first[a]; i < first[a + 1]; ++i)
            same += made.target(leaving[i]) == b;
        for (int i = first[b]; i < first[b + 1]; ++i) {
            if (made.target(leaving[i]) != a) continue;
            ++back;
            made.opposite_[h] = leaving[i];
        }
        if (same != 1 || back > 1) {
            return fail(ErrorKind::badInput,
                        "the mesh is not manifold: triangles meet at an edge that cannot lie on "
                        "one surface, or are turned against each other");
        }
    }
    for (int v = 0; v < int(mesh.vertices.size()); ++v) {
        if (first[v] == first[v + 1]) continue;
        // At the rim the fan is walked from its clockwise end, or some of it would be missed.
        int start = leaving[first[v]];
        for (int i = first[v]; i < first[v + 1]; ++i) {
            if (made.opposite_[leaving[i]] < 0) start = leaving[i];
        }
        made.outgoing_[v] = start;
        int fan = 0, h = start;
        do {
            ++fan;
            h = made.turnLeft(h);
        } while (h >= 0 && h != start);
        if (fan != first[v + 1] - first[v])
            return fail(ErrorKind::badInput, "the mesh is not manifold: sheets meet at one vertex");
    }
    return made;
}

Result<HalfedgeMesh> HalfedgeMesh::ofClosed(const TriMesh& mesh) {
    Result<HalfedgeMesh> made = of(mesh);
    if (made && !made->closed())
        return fail(ErrorKind::badInput, "the mesh is not closed: an edge has one triangle");
    return made;
}

bool HalfedgeMesh::closed() const {
    return std::find(opposite_.begin(), opposite_.end(), -1) == opposite_.end();
}

}  // namespace haustra::mesh
