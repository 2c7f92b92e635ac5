#include "flatten/tube/rim_cut.h"

#include "core/flood_fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/PropertyManager.hh>

namespace haustra::flatten {
namespace {

enum class Side : char { outside, inside, rim };

double leastAngle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const std::array<glm::dvec3, 3> p{a, b, c};
    double least = std::numbers::pi;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
        least = std::min(least, std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)));
    }
    return least;
}

struct DeletableTraits : OpenMesh::DefaultTraits {
    VertexAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::Status);  // else walks meet deleted ones too
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
};

/// Clips triangle by triangle; what is left hangs together as half-edges, without places of their
/// own: face n of `mesh_` is triangle n of `made_`.
class Cutter {
public:
    Cutter(const TriMesh& closed, const TipFunction& function, double level)
        : closed_(closed), function_(function), level_(level), side_(closed.vertices.size()) {
        for (std::size_t v = 0; v < side_.size(); ++v)
            side_[v] = function.value[v] < level ? Side::inside : Side::outside;
        for (std::size_t t = 0; t < closed.triangles.size(); ++t) {
            for (int c = 0; c < 3; ++c) {
                if (function.value[std::size_t(closed.triangles[t][c])] >= 1.0) continue;
                made_.replaced.push_back(int(t));
                break;
            }
        }
    }

    std::optional<RimCut> cut(double snapShare) {
        snap(snapShare);
        for (const int t : made_.replaced)
            cutTriangle(t);
        if (!isManifold_) return std::nullopt;
        dropPockets();
        if (!measure() || !orderRim()) return std::nullopt;
        return std::move(made_);
    }

private:
    using Vertex = OpenMesh::VertexHandle;
    using Halfedge = OpenMesh::HalfedgeHandle;
    using Face = OpenMesh::FaceHandle;

    glm::dvec3 placeOf(int v) const {
        const int old = int(closed_.vertices.size());
        if (v >= old) return made_.added[std::size_t(v - old)];
        const auto moved = moved_.find(v);
        return moved == moved_.end() ? closed_.vertices[std::size_t(v)] : moved->second;
    }

    /// Of the way from `inside` to `outside`, where the level is.
    double shareAt(int inside, int outside) const {
        const double from = function_.value[std::size_t(inside)],
                     to = function_.value[std::size_t(outside)];
        return (level_ - from) / (to - from);
    }

    void snap(double snapShare) {
        struct Move {
            double share;
            int to;
            glm::dvec3 place;
        };
        std::map<int, Move> moves;
        for (const int t : made_.replaced) {
            for (int c = 0; c < 3; ++c) {
                int in = closed_.triangles[std::size_t(t)][c],
                    out = closed_.triangles[std::size_t(t)][(c + 1) % 3];
                if (side_[std::size_t(in)] == side_[std::size_t(out)]) continue;
                if (side_[std::size_t(in)] == Side::outside) std::swap(in, out);
                const double share = shareAt(in, out);
                const bool nearIn = share < 0.5;
                const int mover = nearIn ? in : out, other = nearIn ? out : in;
                const double way = nearIn ? share : 1.0 - share;
                // Without the tip there is no hole; beyond the neighbourhood nothing is replaced.
                if (way >= snapShare || mover == function_.tip || isBeyond(mover)) continue;
                const Move move{way, other,
                                glm::mix(closed_.vertices[std::size_t(in)],
                                         closed_.vertices[std::size_t(out)], share)};
                const auto [held, isNew] = moves.try_emplace(mover, move);
                if (!isNew &&
                    std::pair(way, other) < std::pair(held->second.share, held->second.to))
                    held->second = move;
            }
        }
        for (const auto& [v, move] : moves) {
            side_[std::size_t(v)] = Side::rim;
            moved_[v] = move.place;
            made_.moved.emplace_back(v, move.place);
        }
    }

    int crossing(int in, int out) {
        const int next = int(closed_.vertices.size() + made_.added.size());
        const auto [made, isNew] = crossings_.try_emplace({in, out}, next);
        if (isNew) {
            made_.added.push_back(glm::mix(closed_.vertices[std::size_t(in)],
                                           closed_.vertices[std::size_t(out)], shareAt(in, out)));
        }
        return made->second;
    }

    bool isRim(int v) const {
        return v >= int(closed_.vertices.size()) || side_[std::size_t(v)] == Side::rim;
    }

    void keep(int source, int a, int b, int c) {
        if (isRim(a) && isRim(b) && isRim(c)) return;  // flattened, it would have no area
        made_.triangles.push_back({a, b, c});
        made_.source.push_back(source);
        isManifold_ &= mesh_.add_face(vertex(a), vertex(b), vertex(c)).is_valid();
    }

    Vertex vertex(int number) {
        const auto [known, isNew] = vertexOf_.try_emplace(number);
        if (isNew) number_[known->second = mesh_.add_vertex({})] = number;
        return known->second;
    }
    int from(Halfedge h) const { return number_[mesh_.from_vertex_handle(h)]; }
    int to(Halfedge h) const { return number_[mesh_.to_vertex_handle(h)]; }
    bool alongRim(Halfedge h) const { return isRim(from(h)) && isRim(to(h)); }

    /// Keeps what is outside: the corners and crossings around it, in order.
    void cutTriangle(int t) {
        const glm::ivec3 corners = closed_.triangles[std::size_t(t)];
        std::vector<int> outline;
        bool whole = true;
        for (int c = 0; c < 3; ++c) {
            const int a = corners[c], b = corners[(c + 1) % 3];
            const Side from = side_[std::size_t(a)], to = side_[std::size_t(b)];
            if (from == Side::inside) {
                whole = false;
            } else {
                outline.push_back(a);
            }
            if (from == Side::inside && to == Side::outside) outline.push_back(crossing(a, b));
            if (from == Side::outside && to == Side::inside) outline.push_back(crossing(b, a));
        }
        if (whole) return keep(t, corners.x, corners.y, corners.z);
        if (outline.size() == 3) keep(t, outline[0], outline[1], outline[2]);
        if (outline.size() != 4) return;
        const auto least = [&](int i, int j, int k) {
            return leastAngle(placeOf(outline[std::size_t(i)]), placeOf(outline[std::size_t(j)]),
                              placeOf(outline[std::size_t(k)]));
        };
        if (std::min(least(0, 1, 2), least(0, 2, 3)) >= std::min(least(0, 1, 3), least(1, 2, 3))) {
            keep(t, outline[0], outline[1], outline[2]);
            keep(t, outline[0], outline[2], outline[3]);
        } else {
            keep(t, outline[0], outline[1], outline[3]);
            keep(t, outline[1], outline[2], outline[3]);
        }
    }

    /// What hangs together with the surface beyond the neighbourhood only across edges from rim to
    /// rim would all be flattened onto the rim.
    void dropPockets() {
        std::vector<char> held(mesh_.n_faces(), 0);
        std::vector<Face> front;
        for (const Face face : mesh_.faces()) {
            for (const Vertex v : mesh_.fv_range(face))
                held[std::size_t(face.idx())] |= isBeyond(number_[v]);
            if (held[std::size_t(face.idx())]) front.push_back(face);
        }
        const auto across = [&](Face face, const auto& visit) {
            for (const Halfedge h : mesh_.fh_range(face)) {
                const Face other = mesh_.opposite_face_handle(h);
                if (other.is_valid() && !alongRim(h)) visit(other);
            }
        };
        floodFill(front, across, [&](Face other) {
            return std::exchange(held[std::size_t(other.idx())], 1) == 0;
        });
        std::size_t kept = 0;
        for (std::size_t t = 0; t < held.size(); ++t) {
            if (held[t]) {
                made_.triangles[kept] = made_.triangles[t];
                made_.source[kept++] = made_.source[t];
            } else {
                mesh_.delete_face(Face(int(t)), false);
            }
        }
        made_.triangles.resize(kept);
        made_.source.resize(kept);
    }

    bool isBeyond(int v) const {
        return v < int(closed_.vertices.size()) && function_.value[std::size_t(v)] >= 1.0;
    }

    /// False where a triangle was turned over.
    bool measure() {
        double least = std::numbers::pi, before = 0.0, after = 0.0;
        for (const int t : made_.replaced) {
            const glm::ivec3 c = closed_.triangles[std::size_t(t)];
            before += triangleAreaMm2(closed_.vertices[std::size_t(c.x)],
                                      closed_.vertices[std::size_t(c.y)],
                                      closed_.vertices[std::size_t(c.z)]);
        }
        for (std::size_t t = 0; t < made_.triangles.size(); ++t) {
            const glm::ivec3 c = made_.triangles[t],
                             old = closed_.triangles[std::size_t(made_.source[t])];
            const glm::dvec3 p = placeOf(c.x), q = placeOf(c.y), r = placeOf(c.z);
            const glm::dvec3 o = closed_.vertices[std::size_t(old.x)];
            const glm::dvec3 normal = glm::cross(closed_.vertices[std::size_t(old.y)] - o,
                                                 closed_.vertices[std::size_t(old.z)] - o);
            if (!(glm::dot(glm::cross(q - p, r - p), normal) > 0.0)) return false;
            after += triangleAreaMm2(p, q, r);
            if (isRim(c.x) || isRim(c.y) || isRim(c.z))
                least = std::min(least, leastAngle(p, q, r));
        }
        made_.leastAngleDegrees = least * 180.0 / std::numbers::pi;
        made_.removedMm2 = before - after;
        return true;
    }

    /// False where the rim is not one loop: where sheets of the surface meet at a vertex of the
    /// rim, it goes on in two ways.
    bool orderRim() {
        std::vector<Halfedge> rim;  // the hole is on their left
        for (const Halfedge h : mesh_.halfedges()) {
            if (!mesh_.is_boundary(h) || !alongRim(h)) continue;
            if (!mesh_.is_manifold(mesh_.to_vertex_handle(h))) return false;
            rim.push_back(h);
        }
        if (rim.size() < 3) return false;
        const Halfedge first =
            *std::ranges::min_element(rim, {}, [&](Halfedge h) { return to(h); });
        Halfedge h = first;
        do {
            made_.rim.push_back(to(h));
            made_.rimLengthMm += glm::distance(placeOf(to(h)), placeOf(from(h)));
            h = mesh_.prev_halfedge_handle(h);
        } while (h != first && made_.rim.size() <= rim.size());
        return made_.rim.size() == rim.size();
    }

    const TriMesh& closed_;
    const TipFunction& function_;
    const double level_;
    std::vector<Side> side_;
    std::map<int, glm::dvec3> moved_;
    std::map<std::pair<int, int>, int> crossings_;
    OpenMesh::TriMesh_ArrayKernelT<DeletableTraits> mesh_;
    OpenMesh::VProp<int> number_{mesh_};  ///< in the surface, or after it in made_.added
    std::map<int, Vertex> vertexOf_;
    bool isManifold_ = true;
    RimCut made_;
};

}  // namespace

std::optional<RimCut> cutRim(const TriMesh& closed, const TipFunction& function, double level,
                             double snapShare) {
    return Cutter(closed, function, level).cut(snapShare);
}

}  // namespace haustra::flatten
