#include "mesh/halfedge_mesh.h"

#include <algorithm>
#include <numeric>

namespace haustra::mesh {
namespace {

bool soundTriangles(const std::vector<glm::ivec3>& triangles, int vertexCount) {
    for (const glm::ivec3& t : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            if (t[corner] < 0 || t[corner] >= vertexCount || t[corner] == t[(corner + 1) % 3])
                return false;
        }
    }
    return true;
}

tl::unexpected<Error> unsoundTriangle() {
    return fail(ErrorKind::badInput,
                "a triangle of the mesh repeats a vertex, or names one that does not exist");
}

tl::unexpected<Error> severalFans() {
    return fail(ErrorKind::badInput, "the mesh is not manifold: sheets meet at one vertex");
}

tl::unexpected<Error> tangledEdge() {
    return fail(
        ErrorKind::badInput,
        "the mesh is not manifold: triangles meet at an edge that cannot lie on one surface, "
        "or are turned against each other");
}

}  // namespace

Result<HalfedgeMesh> HalfedgeMesh::of(const TriMesh& mesh) {
    if (!soundTriangles(mesh.triangles, int(mesh.vertices.size()))) return unsoundTriangle();
    HalfedgeMesh made;
    const std::size_t halfedges = mesh.triangles.size() * 3;
    made.origin_.resize(halfedges);
    made.opposite_.assign(halfedges, -1);
    made.outgoing_.resize(mesh.vertices.size());
    made.lengthMm_.resize(halfedges);
    std::vector<int> firsts(mesh.vertices.size() + 1, 0), leavings(halfedges);
    int *origin = made.origin_.data(), *first = firsts.data(), *leaving = leavings.data();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner) {
            origin[3 * t + std::size_t(corner)] = mesh.triangles.data()[t][corner];
            ++first[mesh.triangles.data()[t][corner] + 1];
        }
    std::partial_sum(firsts.begin(), firsts.end(), firsts.begin());
    std::vector<int> ends(firsts.begin(), firsts.end() - 1);
    int* end = ends.data();
    for (std::size_t h = 0; h < halfedges; ++h)
        leaving[end[origin[h]]++] = int(h);

    // Of the half-edges that leave the vertex at hand, the one to each neighbour.
    std::vector<int> allLeads(mesh.vertices.size(), -1);
    int *leads = allLeads.data(), *opposite = made.opposite_.data();
    double* lengthMm = made.lengthMm_.data();
    const glm::dvec3* vertices = mesh.vertices.data();
    for (int v = 0; v < made.vertexCount(); ++v) {
        for (int i = first[v]; i < first[v + 1]; ++i) {
            int& to = leads[made.target(leaving[i])];
            if (to >= 0 && origin[to] == v) return tangledEdge();
            to = leaving[i];
        }
        for (int i = first[v]; i < first[v + 1]; ++i) {
            const int arriving = previous(leaving[i]), from = origin[arriving];
            if (leads[from] >= 0 && origin[leads[from]] == v) opposite[arriving] = leads[from];
            lengthMm[arriving] =
                glm::distance(vertices[std::min(v, from)], vertices[std::max(v, from)]);
        }
    }
    if (!made.findOutgoing()) return severalFans();
    return made;
}

Result<HalfedgeMesh> HalfedgeMesh::glued(int vertexCount, const std::vector<glm::ivec3>& triangles,
                                         std::vector<int> opposite, std::vector<double> lengthMm) {
    const int halfedges = int(triangles.size()) * 3;
    if (!soundTriangles(triangles, vertexCount)) return unsoundTriangle();
    HalfedgeMesh made;
    made.opposite_ = std::move(opposite);
    made.lengthMm_ = std::move(lengthMm);
    made.outgoing_.resize(std::size_t(vertexCount));
    for (const glm::ivec3& t : triangles)
        made.origin_.insert(made.origin_.end(), {t.x, t.y, t.z});
    bool sound = int(made.opposite_.size()) == halfedges && int(made.lengthMm_.size()) == halfedges;
    for (int h = 0; sound && h < halfedges; ++h) {
        const int o = made.opposite_[h];
        if (o == -1) continue;
        sound = o >= 0 && o < halfedges && o != h && made.opposite_[o] == h &&
                made.origin(o) == made.target(h) && made.target(o) == made.origin(h) &&
                made.lengthMm_[o] == made.lengthMm_[h];
    }
    if (!sound) return fail(ErrorKind::badInput, "half-edges that are glued do not fit together");
    if (!made.findOutgoing()) return severalFans();
    return made;
}

bool HalfedgeMesh::findOutgoing() {
    outgoing_.assign(outgoing_.size(), -1);
    std::vector<int> leavings(outgoing_.size(), 0);
    int *outgoingOf = outgoing_.data(), *leaving = leavings.data();
    for (int h = 0; h < halfedgeCount(); ++h) {
        int& start = outgoingOf[origin(h)];
        ++leaving[origin(h)];
        // At the rim the fan is walked from its clockwise end, or some of it would be missed.
        if (start < 0 || opposite(h) < 0) start = h;
    }
    for (int v = 0; v < vertexCount(); ++v) {
        if (outgoing(v) < 0) continue;
        int fan = 0, h = outgoing(v);
        do {
            ++fan;
            h = turnLeft(h);
        } while (h >= 0 && h != outgoing(v));
        if (fan != leaving[v]) return false;
    }
    return true;
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
