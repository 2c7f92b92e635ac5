// A manifold mesh as half-edges: what loops and fronts walk on.
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"

#include <vector>

namespace haustra::mesh {

/// Half-edge h = 3·triangle + corner goes from that corner to the triangle's next one, and has the
/// triangle on its left. Immutable; holds its own copy of the connectivity. OpenMesh is for meshes
/// whose topology changes; METHODS §7.1 "Half-edges and mesh files" sets the two side by side.
class HalfedgeMesh {
public:
    /// Open or closed. Fails (badInput) where an index is out of range, a triangle repeats a
    /// vertex, an edge has more than two triangles or two that disagree on its direction, or a
    /// vertex joins several fans. O(n).
    static Result<HalfedgeMesh> of(const TriMesh& mesh);
    /// As `of`, and fails (badInput) where an edge has only one triangle.
    static Result<HalfedgeMesh> ofClosed(const TriMesh& mesh);
    /// A surface given by its gluing and its edges' lengths alone, which no embedding has to have:
    /// `opposite` and `lengthMm` are per half-edge of `triangles`, −1 at the rim. Two edges may
    /// join the same two vertices. Fails as `of`, and where opposite half-edges do not run against
    /// each other or differ in length.
    static Result<HalfedgeMesh> glued(int vertexCount, const std::vector<glm::ivec3>& triangles,
                                      std::vector<int> opposite, std::vector<double> lengthMm);
    bool closed() const;

    int vertexCount() const { return int(outgoing_.size()); }
    int halfedgeCount() const { return int(origin_.size()); }
    // These take half-edges and vertices of the mesh alone, never the −1 that some of them return:
    // loops around a vertex that know no rim are for closed meshes. By pointers, since such walks
    // are the innermost loops of solvers.
    int origin(int h) const { return origin_.data()[h]; }
    int target(int h) const { return origin_.data()[next(h)]; }
    /// −1 at the rim of an open mesh.
    int opposite(int h) const { return opposite_.data()[h]; }
    double lengthMm(int h) const { return lengthMm_.data()[h]; }
    /// One half-edge that leaves `v`, at the rim the one from which turning left meets all others;
    /// −1 where no triangle uses it.
    int outgoing(int v) const { return outgoing_.data()[v]; }
    /// The next half-edge, counter-clockwise, that leaves the origin of `h`; −1 past the rim.
    int turnLeft(int h) const { return opposite_.data()[previous(h)]; }
    static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }

private:
    /// Fills outgoing_; false where a vertex joins several fans.
    bool findOutgoing();

    std::vector<int> origin_, opposite_, outgoing_;
    std::vector<double> lengthMm_;
};

/// A closed walk: half-edges, each from where the one before it ends.
struct Loop {
    double lengthMm = 0.0;
    std::vector<int> halfedges;
};

}  // namespace haustra::mesh
