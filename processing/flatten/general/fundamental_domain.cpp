#include "flatten/general/fundamental_domain.h"

#include "mesh/cut_graph.h"

#include <algorithm>
#include <cmath>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

/// Numbers the fans that the cut leaves around each vertex: per half-edge, of its origin.
std::vector<int> numberFans(const CarvedSurface& surface, std::vector<int>& vertexOfFan) {
    std::vector<int> fan(std::size_t(surface.halfedgeCount()), -1);
    for (int start = 0; start < surface.halfedgeCount(); ++start) {
        if (fan[std::size_t(start)] >= 0) continue;
        int first = start;
        while (!surface.cut(first)) {
            // Clockwise, until a cut or once around.
            const int right = HalfedgeMesh::next(surface.opposite(first));
            if (right == start) break;
            first = right;
        }
        const int number = int(vertexOfFan.size());
        vertexOfFan.push_back(surface.origin(start));
        int h = first;
        do {
            fan[std::size_t(h)] = number;
            if (surface.cut(HalfedgeMesh::previous(h))) break;
            h = surface.turnLeft(h);
        } while (h != first);
    }
    return fan;
}

/// Of the cut surface. By half-edges: two edges of it may join the same two vertices.
long eulerCharacteristic(const CarvedSurface& surface, std::size_t vertices) {
    long edges = 0;
    for (int h = 0; h < surface.halfedgeCount(); ++h)
        edges += surface.cut(h) || h < surface.opposite(h);
    return long(vertices) - edges + surface.halfedgeCount() / 3;
}

double flatArea(const FundamentalDomain& domain, const glm::ivec3& t) {
    const std::complex<double> a = domain.flat[std::size_t(t.x)];
    return std::imag(std::conj(domain.flat[std::size_t(t.y)] - a) *
                     (domain.flat[std::size_t(t.z)] - a));
}

}  // namespace

Result<FundamentalDomain> layOut(const CarvedSurface& surface) {
    std::vector<int> vertexOfFan;
    const std::vector<int> fan = numberFans(surface, vertexOfFan);
    FundamentalDomain domain;
    for (const int v : vertexOfFan) {
        domain.cut.vertices.push_back(surface.mesh().vertices[std::size_t(v)]);
        domain.vertexOfCut.push_back(surface.sourceVertex(v));
    }
    const std::size_t triangles = fan.size() / 3;
    for (std::size_t t = 0; t < triangles; ++t) {
        domain.cut.triangles.push_back({fan[3 * t], fan[3 * t + 1], fan[3 * t + 2]});
        domain.triangleOfCut.push_back(surface.sourceTriangle(int(t)));
    }
    domain.flat.resize(vertexOfFan.size());
    std::vector<char> placed(vertexOfFan.size(), 0);
    std::vector<int> queue{0};
    std::vector<char> queued(triangles, 0);
    queued[0] = placed[std::size_t(fan[0])] = 1;
    double largest = 0.0, gap = 0.0;
    for (std::size_t n = 0; n < queue.size(); ++n) {
        int h = 3 * queue[n];
        while (!placed[std::size_t(fan[std::size_t(h)])])
            ++h;
        for (int side = 0; side < 3; ++side, h = HalfedgeMesh::next(h)) {
            const auto from = std::size_t(fan[std::size_t(h)]);
            const auto to = std::size_t(fan[std::size_t(HalfedgeMesh::next(h))]);
            const std::complex<double> there = domain.flat[from] + surface.form(h);
            if (placed[to]) gap = std::max(gap, std::abs(domain.flat[to] - there));
            if (!placed[to]) domain.flat[to] = there;
            placed[to] = 1;
            largest = std::max(largest, std::abs(surface.form(h)));
            const int other = surface.opposite(h) / 3;
            if (surface.cut(h) || queued[std::size_t(other)]) continue;
            queued[std::size_t(other)] = 1;
            queue.push_back(other);
        }
    }
    if (queue.size() != triangles || eulerCharacteristic(surface, vertexOfFan.size()) != 1 ||
        !(gap <= 1e-6 * largest)) {
        return fail(ErrorKind::noResult,
                    "the surface cannot be laid out: its cuts do not open it to one disc");
    }
    for (const glm::ivec3& t : domain.cut.triangles)
        domain.flips += !(flatArea(domain, t) > 0.0);
    return domain;
}

Result<FundamentalDomain> fundamentalDomainMap(const TriMesh& mesh, const HalfedgeMesh& halfedges,
                                               const ComplexForm& form) {
    const std::size_t count = mesh.triangles.size() * 3;
    if (count == 0 || !halfedges.closed())
        return fail(ErrorKind::badInput, "the surface is empty or not closed");
    if (form.size() != count || std::size_t(halfedges.halfedgeCount()) != count)
        return fail(ErrorKind::badInput, "the form is not of this surface");
    int root = 0;
    while (halfedges.outgoing(root) < 0)
        ++root;
    const mesh::CutGraph graph = mesh::makeCutGraph(halfedges, root);
    if (graph.basis.empty())
        return fail(ErrorKind::badInput, "the surface is of genus 0 and closed: nothing opens it");
    CarvedSurface surface(mesh, halfedges, form);
    for (int h = 0; h < surface.halfedgeCount(); ++h) {
        if (graph.cut[std::size_t(h)]) surface.setCut(h);
    }
    return layOut(surface);
}

Result<FundamentalDomain> fundamentalDomainMap(const TriMesh& mesh, const ComplexForm& form) {
    const auto halfedges = TRY(HalfedgeMesh::ofClosed(mesh));
    return fundamentalDomainMap(mesh, halfedges, form);
}

std::vector<FormZero> formZeros(const HalfedgeMesh& mesh, const ComplexForm& form) {
    // An edge of no length is taken for one that points the way its lower half-edge does.
    const auto positive = [&](int h) {
        const double value = form[std::size_t(h)].real();
        return value != 0.0 ? value > 0.0 : h < mesh.opposite(h);
    };
    std::vector<FormZero> zeros;
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        if (mesh.outgoing(v) < 0) continue;
        int changes = 0, h = mesh.outgoing(v);
        do {
            const int left = mesh.turnLeft(h);
            changes += positive(h) != positive(left);
            h = left;
        } while (h != mesh.outgoing(v));
        if (changes != 2) zeros.push_back({v, changes / 2 - 1});
    }
    return zeros;
}

}  // namespace haustra::flatten
