// Room for triangles that are too thin for the lattice, from their neighbours.
#pragma once

#include "flatten/tube/flat_places.h"
#include "flatten/tube/flip_repair.h"

#include <algorithm>
#include <vector>

namespace haustra::flatten {

/// Moves the vertices around triangles that the lattice may turn over, ring upon ring, to the
/// middles of their stars, so that these get room from their neighbours. Rims and what is `held`
/// stay.
class Spreading {
public:
    Spreading(PeriodicMap& map, const TriMesh& tube, const VertexStars& stars,
              const std::vector<char>& held, double units)
        : map_(map), tube_(tube), stars_(stars), held_(held), units_(units) {}

    /// Whether all of these, and what they moved, are upright in the end; else all is as before.
    bool run(const std::vector<int>& triangles) {
        constexpr int mostRings = 6, sweeps = 8;
        vertices_.clear();
        before_.clear();
        for (const int t : triangles)
            add(t);
        for (int ring = 0; ring < mostRings; ++ring) {
            if (ring > 0) grow();
            for (int sweep = 0; sweep < sweeps; ++sweep) {
                for (const int v : vertices_)
                    centerInStar(map_, tube_, stars_, v);
            }
            if (sound(triangles)) return true;
        }
        for (std::size_t n = 0; n < vertices_.size(); ++n)
            map_.flat[std::size_t(vertices_[n])] = before_[n];
        return false;
    }

private:
    void add(int t) {
        for (int c = 0; c < 3; ++c) {
            const int v = tube_.triangles[std::size_t(t)][c];
            const glm::dvec2 at = map_.flat[std::size_t(v)];
            if (at.y == 0.0 || at.y == map_.height) continue;
            if (!held_.empty() && held_[std::size_t(v)]) continue;
            if (std::ranges::find(vertices_, v) != vertices_.end()) continue;
            vertices_.push_back(v);
            before_.push_back(at);
        }
    }
    void grow() {
        const std::size_t count = vertices_.size();
        for (std::size_t n = 0; n < count; ++n) {
            for (const int corner : stars_.of(vertices_[n]))
                add(corner / 3);
        }
    }
    bool stands(int t) const {
        const auto n = std::size_t(t);
        return upright(map_.corner(tube_, n, 0), map_.corner(tube_, n, 1), map_.corner(tube_, n, 2),
                       units_);
    }
    bool sound(const std::vector<int>& triangles) const {
        return std::ranges::all_of(triangles, [&](int t) { return stands(t); }) &&
               std::ranges::all_of(vertices_, [&](int v) {
                   return std::ranges::all_of(stars_.of(v),
                                              [&](int corner) { return stands(corner / 3); });
               });
    }

    PeriodicMap& map_;
    const TriMesh& tube_;
    const VertexStars& stars_;
    const std::vector<char>& held_;
    double units_;
    std::vector<int> vertices_;
    std::vector<glm::dvec2> before_;
};

}  // namespace haustra::flatten
