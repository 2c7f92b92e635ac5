#include "simplification/contact.h"

#include <algorithm>

namespace haustra::simplification {
namespace {

constexpr float cellMm = 1.25f;

NamedTriangle cornersOf(const CornerMesh& mesh, int triangle) {
    const int* v = &mesh.vertex[3 * std::size_t(triangle)];
    return {{v[0], v[1], v[2]}, {mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]]}};
}

FloatBox boxOf(const TriangleCorners& p) {
    return FloatBox::around(p[0], p[1], p[2]);
}

/// Whether p, whose planes are given, and q meet other than at their common vertices and edges.
bool meet(const NamedTriangle& first, const SeparatingPlanes& firstPlanes,
          const NamedTriangle& second) {
    int inFirst[3] = {-1, -1, -1}, inSecond[3] = {-1, -1, -1}, shared = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (first.vertex[i] != second.vertex[j]) continue;
            inFirst[shared] = i;
            inSecond[shared++] = j;
        }
    }
    const TriangleCorners &p = first.place, &q = second.place;
    if (shared < 2 && firstPlanes.part(q, inFirst[0], inSecond[0])) return false;
    if (shared == 0) return !apart(p, q);
    if (shared == 1) {
        const int i = inFirst[0], j = inSecond[0];
        return !apartAtVertex(p[i], p[(i + 1) % 3], p[(i + 2) % 3], q[(j + 1) % 3], q[(j + 2) % 3]);
    }
    if (shared == 2) {
        const int a = 3 - inFirst[0] - inFirst[1], b = 3 - inSecond[0] - inSecond[1];
        return !apartAtEdge(p[inFirst[0]], p[inFirst[1]], p[a], q[b]);
    }
    return true;
}

FloatBox boundsOf(std::span<const FloatBox> boxes) {
    if (boxes.empty()) return {glm::vec3(0.0f), glm::vec3(0.0f)};
    FloatBox all = boxes[0];
    for (const FloatBox& box : boxes)
        all.add(box);
    return all;
}

/// The alive triangles that belong(triangle, its box).
template <class Belongs>
TriangleGrid gridOf(const CornerMesh& mesh, const Belongs& belongs) {
    std::vector<int> triangles;
    std::vector<FloatBox> boxes;
    for (int t = 0; t < mesh.triangleCount(); ++t) {
        if (!mesh.alive(t)) continue;
        const FloatBox box = boxOf(cornersOf(mesh, t).place);
        if (!belongs(t, box)) continue;
        triangles.push_back(t);
        boxes.push_back(box);
    }
    const FloatBox all = boundsOf(boxes);
    TriangleGrid grid(all.low, all.high, cellMm);
    for (std::size_t i = 0; i < boxes.size(); ++i)
        grid.insert(triangles[i], boxes[i]);
    return grid;
}

}  // namespace

ContactGuard::ContactGuard(const CornerMesh& mesh, std::span<const FloatBox> guarded)
    : mesh_(mesh),
      guarded_(guarded),
      grid_(gridOf(mesh, [&](int, const FloatBox& box) { return guards(box); })) {}

bool ContactGuard::guards(const FloatBox& box) const {
    return std::any_of(guarded_.begin(), guarded_.end(),
                       [&](const FloatBox& guarded) { return guarded.touches(box); });
}

bool ContactGuard::refuses(const Replacement& r) {
    if (guarded_.empty()) return false;
    triangles_.clear();
    boxes_.clear();
    planes_.clear();
    for (const auto& v : r.corners) {
        triangles_.push_back(
            {v, {r.placeOf(mesh_, v[0]), r.placeOf(mesh_, v[1]), r.placeOf(mesh_, v[2])}});
        boxes_.push_back(boxOf(triangles_.back().place));
    }
    const FloatBox all = boundsOf(boxes_);
    if (!guards(all)) return false;
    for (const NamedTriangle& triangle : triangles_)
        planes_.emplace_back(triangle.place);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        for (std::size_t j = i + 1; j < triangles_.size(); ++j) {
            if (meet(triangles_[i], planes_[i], triangles_[j])) return true;
        }
    }
    bool found = false;
    grid_.visit(all, [&](int t, const FloatBox& box) {
        if (found ||
            std::find(r.oldTriangles.begin(), r.oldTriangles.end(), t) != r.oldTriangles.end()) {
            return;
        }
        const NamedTriangle other = cornersOf(mesh_, t);
        for (std::size_t i = 0; i < triangles_.size() && !found; ++i)
            found = boxes_[i].touches(box) && meet(triangles_[i], planes_[i], other);
    });
    return found;
}

void ContactGuard::remove(const Replacement& r) {
    if (guarded_.empty()) return;
    for (const int t : r.oldTriangles) {
        const FloatBox box = boxOf(cornersOf(mesh_, t).place);
        if (guards(box)) grid_.remove(t, box);
    }
}

void ContactGuard::insert(const Replacement& r) {
    if (guarded_.empty()) return;
    for (const int t : r.newTriangles) {
        const FloatBox box = boxOf(cornersOf(mesh_, t).place);
        if (guards(box)) grid_.insert(t, box);
    }
}

std::vector<FloatBox> contacts(const CornerMesh& mesh, const std::vector<char>& changed) {
    const TriangleGrid grid = gridOf(mesh, [](int, const FloatBox&) { return true; });
    std::vector<FloatBox> found;
    for (int t = 0; t < mesh.triangleCount(); ++t) {
        if (!mesh.alive(t) || !changed[t]) continue;
        const NamedTriangle triangle = cornersOf(mesh, t);
        const FloatBox triangleBox = boxOf(triangle.place);
        const SeparatingPlanes planes(triangle.place);
        grid.visit(triangleBox, [&](int other, const FloatBox& box) {
            if (other == t || (changed[other] && other < t)) return;
            if (!meet(triangle, planes, cornersOf(mesh, other))) return;
            found.push_back(triangleBox);
            found.back().add(box);
        });
    }
    return found;
}

}  // namespace haustra::simplification
