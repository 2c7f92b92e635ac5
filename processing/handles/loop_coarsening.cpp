#include "handles/loop_coarsening.h"

#include <algorithm>
#include <numeric>
#include <queue>
#include <tuple>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

namespace haustra::handles {
namespace {

struct CollapsibleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::None);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
};

/// Vertices and faces keep the fine mesh's numbers: what is deleted is never collected.
class Coarsening {
public:
    explicit Coarsening(const TriMesh& fine) : fine_(fine), becomes_(fine.vertices.size()) {
        std::iota(becomes_.begin(), becomes_.end(), 0);
        mesh_.reserve(fine.vertices.size(), fine.triangles.size() * 3 / 2, fine.triangles.size());
        for (const glm::dvec3& p : fine.vertices)
            mesh_.add_vertex({p.x, p.y, p.z});
        for (const glm::ivec3& t : fine.triangles)
            mesh_.add_face(Vertex(t.x), Vertex(t.y), Vertex(t.z));
        for (const Vertex v : mesh_.vertices())
            used_ += !mesh_.is_isolated(v);
    }

    /// One pass over all edges and those that collapses make; true where something collapsed.
    bool pass(int target, bool keepShape) {
        const int before = used_;
        for (const auto edge : mesh_.edges())
            push(edge.v0(), edge.v1());
        while (used_ > target && !queue_.empty()) {
            const auto [length, a, b] = queue_.top();
            queue_.pop();
            const Halfedge along = mesh_.find_halfedge(Vertex(a), Vertex(b));
            if (!along.is_valid()) continue;  // another collapse has taken the edge away
            const unsigned aroundA = mesh_.valence(Vertex(a)), aroundB = mesh_.valence(Vertex(b));
            if (keepShape && aroundA + aroundB - 4 > mostTriangles_) continue;
            // The link condition; OpenMesh alone would let a tetrahedron fall in.
            if (aroundA + aroundB <= 6 || !mesh_.is_collapse_ok(along)) continue;
            const Halfedge back = mesh_.opposite_halfedge_handle(along);
            for (const Halfedge h :
                 {aroundA <= aroundB ? along : back, aroundA <= aroundB ? back : along}) {
                if (keepShape && foldsOver(h)) continue;
                collapse(h);
                break;
            }
        }
        queue_ = {};
        return used_ < before;
    }

    int used() const { return used_; }

    CoarseMesh result() const {
        CoarseMesh coarse;
        std::vector<int> number(fine_.vertices.size(), -1);
        for (const Vertex v : mesh_.vertices()) {
            if (mesh_.is_isolated(v)) continue;
            number[std::size_t(v.idx())] = int(coarse.fineVertex.size());
            coarse.fineVertex.push_back(v.idx());
            coarse.mesh.vertices.push_back(fine_.vertices[std::size_t(v.idx())]);
        }
        const auto numberOf = [&](int v) {
            while (becomes_[std::size_t(v)] != v)
                v = becomes_[std::size_t(v)];
            return number[std::size_t(v)];
        };
        for (const auto face : mesh_.faces()) {
            const glm::ivec3& t = fine_.triangles[std::size_t(face.idx())];
            coarse.mesh.triangles.push_back({numberOf(t.x), numberOf(t.y), numberOf(t.z)});
        }
        return coarse;
    }

private:
    using Mesh = OpenMesh::TriMesh_ArrayKernelT<CollapsibleTraits>;
    using Vertex = OpenMesh::VertexHandle;
    using Halfedge = OpenMesh::HalfedgeHandle;
    using Point = OpenMesh::Vec3d;
    using Entry = std::tuple<double, int, int>;  // squared length, ends

    static constexpr unsigned mostTriangles_ = 16;  // around a vertex, so that collapses stay local

    void push(Vertex a, Vertex b) {
        queue_.push({(mesh_.point(b) - mesh_.point(a)).sqrnorm(), std::min(a.idx(), b.idx()),
                     std::max(a.idx(), b.idx())});
    }

    /// Whether taking the half-edge's origin into its end turns a triangle by over 78°.
    bool foldsOver(Halfedge h) const {
        const Vertex gone = mesh_.from_vertex_handle(h), kept = mesh_.to_vertex_handle(h);
        for (const auto leaving : mesh_.voh_range(gone)) {
            const Vertex b = leaving.to(), c = leaving.next().to();
            if (b == kept || c == kept) continue;
            const Point p = mesh_.point(b), q = mesh_.point(c);
            const auto normalAt = [&](Vertex a) {
                return (p - mesh_.point(a)) % (q - mesh_.point(a));
            };
            const Point before = normalAt(gone), after = normalAt(kept);
            if ((before | after) <= 0.2 * before.norm() * after.norm()) return true;
        }
        return false;
    }

    /// Takes the half-edge's origin into its end.
    void collapse(Halfedge h) {
        const Vertex gone = mesh_.from_vertex_handle(h), kept = mesh_.to_vertex_handle(h);
        for (const Vertex v : mesh_.vv_range(gone))
            if (v != kept) push(kept, v);
        mesh_.collapse(h);
        becomes_[std::size_t(gone.idx())] = kept.idx();
        --used_;
    }

    const TriMesh& fine_;
    Mesh mesh_;
    std::vector<int> becomes_;  ///< the vertex that each has been taken into, or itself
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
    int used_ = 0;
};

}  // namespace

CoarseMesh coarsen(const TriMesh& fine, int vertices) {
    Coarsening coarsening(fine);
    for (const bool keepShape : {true, false}) {
        while (coarsening.used() > vertices && coarsening.pass(vertices, keepShape)) {
        }
    }
    return coarsening.result();
}

}  // namespace haustra::handles
