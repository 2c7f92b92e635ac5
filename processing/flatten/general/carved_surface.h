// A surface with a form on it, into which lines are carved as edges.
#pragma once

#include "flatten/general/holomorphic_forms.h"

#include <complex>
#include <vector>

namespace haustra::flatten {

/// A closed surface whose edges can be split; half-edges are numbered as in HalfedgeMesh. The
/// closed form stays linear in each of the original triangles.
class CarvedSurface {
public:
    CarvedSurface(const TriMesh& mesh, const mesh::HalfedgeMesh& halfedges, ComplexForm form);

    const TriMesh& mesh() const { return mesh_; }
    int halfedgeCount() const { return int(opposite_.size()); }
    int origin(int h) const { return mesh_.triangles[std::size_t(h / 3)][h % 3]; }
    int target(int h) const { return origin(mesh::HalfedgeMesh::next(h)); }
    int opposite(int h) const { return opposite_[std::size_t(h)]; }
    int outgoing(int v) const { return outgoing_[std::size_t(v)]; }
    int turnLeft(int h) const { return opposite(mesh::HalfedgeMesh::previous(h)); }
    std::complex<double> form(int h) const { return form_[std::size_t(h)]; }

    bool cut(int h) const { return cut_[std::size_t(h)] != 0; }
    void setCut(int h);
    int sourceVertex(int v) const { return sourceVertex_[std::size_t(v)]; }  ///< −1: of a split
    int sourceTriangle(int t) const { return sourceTriangle_[std::size_t(t)]; }

    /// A new vertex on h's edge at the fraction `at` from its origin; h then ends there. Both
    /// triangles become two. Returns the vertex.
    int split(int h, double at);

private:
    TriMesh mesh_;
    std::vector<int> opposite_, outgoing_, sourceVertex_, sourceTriangle_;
    ComplexForm form_;
    std::vector<char> cut_;
};

}  // namespace haustra::flatten
