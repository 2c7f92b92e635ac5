// A closed mesh as half-edges: what loops walk on.
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"

#include <vector>

namespace haustra::surface {

/// Half-edge h = 3·triangle + corner goes from that corner to the triangle's next one, and has the
/// triangle on its left. Immutable; holds its own copy of the connectivity.
class LoopMesh {
public:
    /// Fails (badInput) where an index is out of range, a triangle repeats a vertex, an edge does
    /// not have exactly two triangles that agree on its direction, or a vertex joins several fans.
    /// O(n).
    static Result<LoopMesh> of(const TriMesh& mesh);

    int vertexCount() const { return int(outgoing_.size()); }
    int halfedgeCount() const { return int(origin_.size()); }
    int origin(int h) const { return origin_[h]; }
    int target(int h) const { return origin_[next(h)]; }
    int opposite(int h) const { return opposite_[h]; }
    double lengthMm(int h) const { return lengthMm_[h]; }
    /// One half-edge that leaves `v`; −1 where no triangle uses it.
    int outgoing(int v) const { return outgoing_[v]; }
    /// The next half-edge, counter-clockwise, that leaves the origin of `h`.
    int turnLeft(int h) const { return opposite_[previous(h)]; }
    static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }

private:
    std::vector<int> origin_, opposite_, outgoing_;
    std::vector<double> lengthMm_;
};

/// A closed walk: half-edges, each from where the one before it ends.
struct Loop {
    double lengthMm = 0.0;
    std::vector<int> halfedges;
};

}  // namespace haustra::surface
