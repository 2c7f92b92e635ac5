#include "handles/loop_coarsening.h"

#include <algorithm>
#include <queue>
#include <tuple>

namespace haustra::handles {
namespace {

class Coarsening {
public:
    Coarsening(const TriMesh& fine) : mesh_(fine), around_(fine.vertices.size()) {
        mark_.assign(fine.vertices.size(), 0);
        std::vector<int> valence(fine.vertices.size(), 0);
        for (const glm::ivec3& t : mesh_.triangles) {
            for (int corner = 0; corner < 3; ++corner)
                ++valence[t[corner]];
        }
        for (std::size_t v = 0; v < valence.size(); ++v) {
            around_[v].reserve(std::size_t(valence[v]));
            used_ += valence[v] > 0;
        }
        for (int t = 0; t < int(mesh_.triangles.size()); ++t) {
            for (int corner = 0; corner < 3; ++corner)
                around_[mesh_.triangles[t][corner]].push_back(t);
        }
    }

    /// One pass over all edges and those that collapses make; true where something collapsed.
    bool pass(int target, bool keepShape) {
        const int before = used_;
        for (const glm::ivec3& t : mesh_.triangles) {
            for (int corner = 0; corner < 3 && t.x >= 0; ++corner) {
                if (t[corner] < t[(corner + 1) % 3]) push(t[corner], t[(corner + 1) % 3]);
            }
        }
        while (used_ > target && !queue_.empty()) {
            const auto [length, a, b] = queue_.top();
            queue_.pop();
            const bool aIsSmaller = around_[a].size() <= around_[b].size();
            const int gone = aIsSmaller ? a : b, kept = aIsSmaller ? b : a;
            if (!collapse(gone, kept, keepShape)) collapse(kept, gone, keepShape);
        }
        queue_ = {};
        return used_ < before;
    }

    int used() const { return used_; }

    CoarseMesh result() const {
        CoarseMesh coarse;
        std::vector<int> number(mesh_.vertices.size(), -1);
        for (int v = 0; v < int(mesh_.vertices.size()); ++v) {
            if (around_[v].empty()) continue;
            number[v] = int(coarse.fineVertex.size());
            coarse.fineVertex.push_back(v);
            coarse.mesh.vertices.push_back(mesh_.vertices[v]);
        }
        for (const glm::ivec3& t : mesh_.triangles) {
            if (t.x >= 0) coarse.mesh.triangles.push_back({number[t.x], number[t.y], number[t.z]});
        }
        return coarse;
    }

private:
    static constexpr std::size_t mostTriangles_ =
        16;  // around a vertex, so that collapses stay local

    void push(int a, int b) {
        const glm::dvec3 along = mesh_.vertices[b] - mesh_.vertices[a];
        queue_.push({glm::dot(along, along), std::min(a, b), std::max(a, b)});
    }

    glm::dvec3 normal(const glm::ivec3& t) const {
        const glm::dvec3 &a = mesh_.vertices[t.x], &b = mesh_.vertices[t.y],
                         &c = mesh_.vertices[t.z];
        return glm::cross(b - a, c - a);
    }

    bool has(const glm::ivec3& t, int v) const { return t.x == v || t.y == v || t.z == v; }

    /// Exactly the two vertices opposite the edge are joined to both ends, and it is not the edge
    /// of a tetrahedron.
    bool linkCondition(int gone, int kept) {
        ++stamp_;
        int shared = 0, common = 0;
        for (const int t : around_[gone]) {
            shared += has(mesh_.triangles[t], kept);
            for (int corner = 0; corner < 3; ++corner)
                mark_[mesh_.triangles[t][corner]] = stamp_;
        }
        if (shared != 2) return false;
        mark_[gone] = mark_[kept] = 0;
        for (const int t : around_[kept]) {
            for (int corner = 0; corner < 3; ++corner) {
                int& mark = mark_[mesh_.triangles[t][corner]];
                if (mark == stamp_) {
                    ++common;
                    mark = 0;
                }
            }
        }
        return common == 2 && around_[gone].size() + around_[kept].size() > 6;
    }

    bool keepsShape(int gone, int kept) const {
        if (around_[gone].size() + around_[kept].size() - 4 > mostTriangles_) return false;
        for (const int t : around_[gone]) {
            glm::ivec3 moved = mesh_.triangles[t];
            if (has(moved, kept)) continue;
            const glm::dvec3 before = normal(moved);
            for (int corner = 0; corner < 3; ++corner) {
                if (moved[corner] == gone) moved[corner] = kept;
            }
            const glm::dvec3 after = normal(moved);
            if (glm::dot(before, after) <= 0.2 * glm::length(before) * glm::length(after))
                return false;
        }
        return true;
    }

    void forget(int v, int t) {
        auto& list = around_[v];
        list.erase(std::find(list.begin(), list.end(), t));
    }

    bool collapse(int gone, int kept, bool keepShape) {
        if (around_[gone].empty() || around_[kept].empty() || !linkCondition(gone, kept))
            return false;
        if (keepShape && !keepsShape(gone, kept)) return false;
        for (const int t : around_[gone]) {
            glm::ivec3& triangle = mesh_.triangles[t];
            if (has(triangle, kept)) {
                for (int corner = 0; corner < 3; ++corner) {
                    if (triangle[corner] != gone) forget(triangle[corner], t);
                }
                triangle = glm::ivec3(-1);
                continue;
            }
            for (int corner = 0; corner < 3; ++corner) {
                if (triangle[corner] == gone) triangle[corner] = kept;
            }
            around_[kept].push_back(t);
            for (int corner = 0; corner < 3; ++corner) {
                if (triangle[corner] != kept) push(triangle[corner], kept);
            }
        }
        around_[gone].clear();
        --used_;
        return true;
    }

    using Entry = std::tuple<double, int, int>;
    TriMesh mesh_;
    std::vector<std::vector<int>> around_;
    std::vector<int> mark_;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
    int stamp_ = 0, used_ = 0;
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
