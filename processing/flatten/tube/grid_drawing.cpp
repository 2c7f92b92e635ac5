#include "flatten/tube/grid_drawing.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace haustra::flatten {
namespace {

/// Vertices are taken off the upper side, from corner 2 on, while what is left stays a disc on the
/// edge from corner 0 to corner 1 (de Fraysseix, Pach and Pollack 1990). Each leaves three edges:
/// to its neighbour on the left of the side, to that on the right, and to the one that uncovered
/// it.
class Shelling {
public:
    Shelling(const std::vector<glm::ivec3>& triangles, int vertices)
        : neighbours_(std::size_t(vertices)),
          left_(std::size_t(vertices), -1),
          right_(std::size_t(vertices), -1),
          chords_(std::size_t(vertices), 0),
          state_(std::size_t(vertices), State::covered),
          parent_(std::size_t(vertices), {-1, -1, -1}) {
        follows_.reserve(triangles.size() * 3);
        for (const glm::ivec3& t : triangles) {
            for (int c = 0; c < 3; ++c) {
                const int v = t[c], w = t[(c + 1) % 3];
                sound_ = sound_ && follows_.emplace(keyOf(v, w), t[(c + 2) % 3]).second;
                neighbours_[std::size_t(v)].push_back(w);
                // A side of the whole is of one triangle alone.
                if (v < 3 && w == (v + 1) % 3) neighbours_[std::size_t(w)].push_back(v);
            }
        }
    }

    bool run() {
        if (!sound_ || state_.size() < 3) return false;
        left_[2] = 0, right_[2] = 1;
        right_[0] = 2, left_[1] = 2;
        for (const std::size_t v : {0, 1, 2})
            state_[v] = State::side;
        std::vector<int> free{2};
        while (!free.empty()) {
            const int v = free.back();
            free.pop_back();
            if (!isFree(v)) continue;
            if (!takeOff(v, free)) return false;
        }
        return order_.size() + 2 == state_.size();
    }

    const std::vector<int>& order() const { return order_; }  ///< all but corners 0 and 1
    /// Per vertex: towards corner 0, 1 and 2; −1 from a corner.
    const std::vector<std::array<int, 3>>& parents() const { return parent_; }

private:
    enum class State : char { covered, side, gone };

    static std::uint64_t keyOf(int from, int to) {
        return std::uint64_t(std::uint32_t(from)) << 32 | std::uint32_t(to);
    }
    bool isFree(int v) const {
        return v > 1 && state_[std::size_t(v)] == State::side && chords_[std::size_t(v)] == 0;
    }

    bool takeOff(int v, std::vector<int>& free) {
        const int left = left_[std::size_t(v)], right = right_[std::size_t(v)];
        std::vector<int> uncovered;
        for (int u = left;;) {
            const auto next = follows_.find(keyOf(v, u));
            if (next == follows_.end()) return false;
            u = next->second;
            if (u == right) break;
            if (state_[std::size_t(u)] != State::covered) return false;
            state_[std::size_t(u)] = State::side;
            uncovered.push_back(u);
        }
        state_[std::size_t(v)] = State::gone;
        order_.push_back(v);
        if (v != 2) parent_[std::size_t(v)][0] = left, parent_[std::size_t(v)][1] = right;
        int before = left;
        for (const int u : uncovered) {
            parent_[std::size_t(u)][2] = v;
            link(before, u);
            before = u;
        }
        link(before, right);
        if (uncovered.empty()) {
            // What was a chord now is of the side.
            for (const int u : {left, right}) {
                --chords_[std::size_t(u)];
                if (isFree(u)) free.push_back(u);
            }
        }
        for (const int u : uncovered) {
            for (const int w : neighbours_[std::size_t(u)]) {
                if (state_[std::size_t(w)] != State::side || w == left_[std::size_t(u)] ||
                    w == right_[std::size_t(u)])
                    continue;
                ++chords_[std::size_t(u)];
                // Between two new ones each counts its own.
                if (parent_[std::size_t(w)][2] != v) ++chords_[std::size_t(w)];
            }
        }
        for (const int u : uncovered) {
            if (isFree(u)) free.push_back(u);
        }
        return true;
    }

    void link(int left, int right) {
        right_[std::size_t(left)] = right;
        left_[std::size_t(right)] = left;
    }

    std::unordered_map<std::uint64_t, int>
        follows_;  ///< around the first, what is after the second
    std::vector<std::vector<int>> neighbours_;
    std::vector<int> left_, right_;  ///< along the upper side
    std::vector<int> chords_;        ///< of a vertex on the side: edges to others, not along it
    std::vector<State> state_;
    std::vector<std::array<int, 3>> parent_;
    std::vector<int> order_;
    bool sound_ = true;
};

}  // namespace

std::optional<std::vector<glm::ivec3>> drawOnGrid(const std::vector<glm::ivec3>& triangles,
                                                  int vertices) {
    Shelling shelling(triangles, vertices);
    if (!shelling.run()) return std::nullopt;
    const auto count = std::size_t(vertices);
    const auto& parents = shelling.parents();
    std::vector<int> inner;  // those taken off earlier first
    for (const int v : shelling.order()) {
        if (v > 2) inner.push_back(v);
    }
    // Parents towards corner 2 are taken off before, those towards the others after.
    const auto fromRoot = [&](int tree, const auto& visit) {
        for (std::size_t n = 0; n < inner.size(); ++n)
            visit(std::size_t(inner[tree == 2 ? n : inner.size() - 1 - n]));
    };
    const auto toRoot = [&](int tree, const auto& visit) {
        for (std::size_t n = 0; n < inner.size(); ++n)
            visit(std::size_t(inner[tree == 2 ? inner.size() - 1 - n : n]));
    };
    std::vector<std::array<int, 3>> below(count, {1, 1, 1});  // vertices of a tree from here on
    std::vector<std::array<int, 3>> path(count, {1, 1, 1});   // vertices from here to the root
    std::vector<glm::ivec3> places(count, glm::ivec3(0));
    for (int tree = 0; tree < 3; ++tree) {
        const auto i = std::size_t(tree);
        toRoot(tree, [&](std::size_t v) { below[std::size_t(parents[v][i])][i] += below[v][i]; });
        fromRoot(tree, [&](std::size_t v) { path[v][i] += path[std::size_t(parents[v][i])][i]; });
    }
    for (int tree = 0; tree < 3; ++tree) {
        // The region of a vertex that its paths to the other two corners part from this one.
        const auto i = std::size_t(tree);
        for (const int other : {(tree + 1) % 3, (tree + 2) % 3}) {
            std::vector<int> along(count, 1);
            fromRoot(other, [&](std::size_t v) {
                along[v] = along[std::size_t(parents[v][std::size_t(other)])] + below[v][i];
            });
            for (const int v : inner)
                places[std::size_t(v)][tree] += along[std::size_t(v)];
        }
        for (const int v : inner) {
            places[std::size_t(v)][tree] -=
                below[std::size_t(v)][i] + path[std::size_t(v)][std::size_t((tree + 2) % 3)];
        }
    }
    for (int c = 0; c < 3; ++c) {
        places[std::size_t(c)][c] = vertices - 2;
        places[std::size_t(c)][(c + 1) % 3] = 1;
    }
    return places;
}

}  // namespace haustra::flatten
