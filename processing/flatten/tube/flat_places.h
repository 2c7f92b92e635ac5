// Where vertices and triangles lie in a tube's map.
#pragma once

#include "core/flood_fill.h"
#include "flatten/periodic_map.h"
#include "flatten/tube/vertex_stars.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace haustra::flatten {

/// The flat place of a vertex in the copy of the strip that is nearest to `middle`.
inline glm::dvec2 placeNear(const PeriodicMap& map, int v, glm::dvec2 middle) {
    const glm::dvec2 at = map.flat[std::size_t(v)];
    return {at.x - std::round(at.x - middle.x), at.y};
}

inline double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

/// Whether three places, rounded however the strip is turned, are counter-clockwise.
inline bool upright(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, double units) {
    const glm::dvec2 p = b - a, q = c - a, r = q - p;
    const double longest = std::sqrt(std::max({glm::dot(p, p), glm::dot(q, q), glm::dot(r, r)}));
    // Each corner moves by up to 2^−½ of a unit.
    return cross(p, q) > 2.0 * longest / units;
}

/// Triangles that hang together over vertices, in ascending order of their lowest.
inline std::vector<std::vector<int>> clustersOf(const TriMesh& tube, const VertexStars& stars,
                                                const std::vector<int>& triangles) {
    std::vector<char> waiting(tube.triangles.size(), 0);
    for (const int t : triangles)
        waiting[std::size_t(t)] = 1;
    std::vector<std::vector<int>> clusters;
    for (const int seed : triangles) {
        if (!waiting[std::size_t(seed)]) continue;
        std::vector<int>& cluster = clusters.emplace_back(1, seed);
        waiting[std::size_t(seed)] = 0;
        const auto sharingVertices = [&](int t, const auto& visit) {
            for (int c = 0; c < 3; ++c) {
                for (const int corner : stars.of(tube.triangles[std::size_t(t)][c]))
                    visit(corner / 3);
            }
        };
        floodFill(cluster, sharingVertices, [&](int t) {
            if (!waiting[std::size_t(t)]) return false;
            waiting[std::size_t(t)] = 0;
            return true;
        });
    }
    return clusters;
}

}  // namespace haustra::flatten
