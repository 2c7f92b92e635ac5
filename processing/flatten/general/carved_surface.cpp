#include "flatten/general/carved_surface.h"

#include <utility>

namespace haustra::flatten {

using mesh::HalfedgeMesh;

CarvedSurface::CarvedSurface(const TriMesh& mesh, const HalfedgeMesh& halfedges, ComplexForm form)
    : mesh_(mesh), form_(std::move(form)), cut_(form_.size(), 0) {
    for (int h = 0; h < halfedges.halfedgeCount(); ++h)
        opposite_.push_back(halfedges.opposite(h));
    for (int v = 0; v < halfedges.vertexCount(); ++v) {
        outgoing_.push_back(halfedges.outgoing(v));
        sourceVertex_.push_back(v);
    }
    for (int t = 0; t < int(mesh.triangles.size()); ++t)
        sourceTriangle_.push_back(t);
}

void CarvedSurface::setCut(int h) {
    cut_[std::size_t(h)] = cut_[std::size_t(opposite(h))] = 1;
}

int CarvedSurface::split(int h, double at) {
    // h is a → b in the triangle a b c, g is b → a in b a d; p comes between. They become a p c
    // and p a d; p b c and b p d are new.
    const int g = opposite(h), a = origin(h), b = target(h), p = int(mesh_.vertices.size());
    const int bc = HalfedgeMesh::next(h), ad = HalfedgeMesh::next(g);
    const int db = HalfedgeMesh::previous(g);
    const int c = target(bc), d = origin(db);
    const std::complex<double> ap = form(h) * at, pb = form(h) - ap;
    const std::complex<double> pc = pb + form(bc), pd = form(ad) - ap;

    mesh_.vertices.push_back(
        glm::mix(mesh_.vertices[std::size_t(a)], mesh_.vertices[std::size_t(b)], at));
    sourceVertex_.push_back(-1);
    const int k = halfedgeCount();  // the first new half-edge
    mesh_.triangles.push_back({p, b, c});
    mesh_.triangles.push_back({b, p, d});
    sourceTriangle_.push_back(sourceTriangle(h / 3));
    sourceTriangle_.push_back(sourceTriangle(g / 3));
    opposite_.insert(opposite_.end(), {k + 3, opposite(bc), bc, k, db, opposite(db)});
    form_.insert(form_.end(), {pb, form(bc), -pc, -pb, pd, form(db)});
    const auto wasCut = [&](int old) { return cut_[std::size_t(old)]; };
    cut_.insert(cut_.end(), {wasCut(h), wasCut(bc), 0, wasCut(h), 0, wasCut(db)});
    opposite_[std::size_t(opposite(bc))] = k + 1;
    opposite_[std::size_t(opposite(db))] = k + 5;

    mesh_.triangles[std::size_t(h / 3)][bc % 3] = p;
    mesh_.triangles[std::size_t(g / 3)][g % 3] = p;
    const auto set = [&](int old, int other, std::complex<double> value) {
        opposite_[std::size_t(old)] = other;
        form_[std::size_t(old)] = value;
    };
    set(h, g, ap);
    set(g, h, -ap);
    set(bc, k + 2, pc);
    set(db, k + 4, -pd);
    cut_[std::size_t(bc)] = cut_[std::size_t(db)] = 0;
    outgoing_.push_back(k);
    outgoing_[std::size_t(b)] = k + 1;
    return p;
}

}  // namespace haustra::flatten
