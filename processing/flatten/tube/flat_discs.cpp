#include "flatten/tube/flat_discs.h"

#include "core/flood_fill.h"
#include "flatten/tube/flat_places.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace haustra::flatten {

Spot spotOf(const TriMesh& tube, const PeriodicMap& map, std::vector<int> triangles) {
    Spot spot;
    const glm::dvec2 first = map.corner(tube, std::size_t(triangles.front()), 0);
    for (const int t : triangles) {
        for (int c = 0; c < 3; ++c)
            spot.middle += placeNear(map, tube.triangles[std::size_t(t)][c], first) - first;
    }
    spot.middle = first + spot.middle / (3.0 * double(triangles.size()));
    for (const int t : triangles) {
        for (int c = 0; c < 3; ++c) {
            spot.reach = std::max(
                spot.reach,
                glm::distance(placeNear(map, tube.triangles[std::size_t(t)][c], spot.middle),
                              spot.middle));
        }
    }
    spot.triangles = std::move(triangles);
    return spot;
}

double largestRadiusAround(const PeriodicMap& map, glm::dvec2 middle) {
    constexpr double aroundStrip = 0.25, towardsRim = 0.8;
    return std::min({aroundStrip, towardsRim * middle.y, towardsRim * (map.height - middle.y)});
}

template <class Take>
void Discs::grow(std::vector<int>& triangles, const Take& take) const {
    const auto beside = [&](int t, const auto& visit) {
        for (int c = 0; c < 3; ++c) {
            if (const int other = halfedges_.opposite(3 * t + c); other >= 0) visit(other / 3);
        }
    };
    floodFill(triangles, beside, take);
}

std::optional<Pouch> Discs::within(const PeriodicMap& map, const std::vector<int>& seeds,
                                   glm::dvec2 middle, double radius,
                                   const std::vector<char>& taken) {
    const auto isWithin = [&](int t) {
        for (int c = 0; c < 3; ++c) {
            const int v = tube_.triangles[std::size_t(t)][c];
            const double y = map.flat[std::size_t(v)].y;
            if (y == 0.0 || y == map.height ||
                !(glm::distance(placeNear(map, v, middle), middle) < radius))
                return false;
        }
        return true;
    };
    std::vector<int> found;
    const auto take = [&](int t) {
        if (inside_[std::size_t(t)] || !isWithin(t)) return false;
        inside_[std::size_t(t)] = 1;
        return true;
    };
    for (const int seed : seeds) {
        if (take(seed)) found.push_back(seed);
    }
    grow(found, take);
    const bool whole =
        std::ranges::all_of(seeds, [&](int t) { return inside_[std::size_t(t)] != 0; });
    std::optional<Pouch> pouch;
    if (whole && close(found) &&
        std::ranges::none_of(found, [&](int t) { return taken[std::size_t(t)] != 0; }))
        pouch = Pouch{found, middle, radius};
    for (const int t : found)
        inside_[std::size_t(t)] = 0;
    return pouch;
}

bool Discs::close(std::vector<int>& found) {
    for (int round = 0; round < 8; ++round) {
        std::unordered_map<int, int> leaves;  // border half-edges by their origins
        std::vector<int> pinched, starts;
        for (const int t : found) {
            for (int h = 3 * t; h < 3 * t + 3; ++h) {
                if (!isBorder(h)) continue;
                if (halfedges_.opposite(h) < 0) return false;
                starts.push_back(h);
                if (!leaves.emplace(halfedges_.origin(h), h).second)
                    pinched.push_back(halfedges_.origin(h));
            }
        }
        for (const int v : pinched) {
            for (const int corner : stars_.of(v)) {
                const auto t = std::size_t(corner / 3);
                if (inside_[t]) continue;
                inside_[t] = 1;
                found.push_back(int(t));
            }
        }
        if (!pinched.empty()) continue;
        std::unordered_map<int, int> loopOf;
        int loops = 0;
        for (const int start : starts) {
            if (loopOf.contains(start)) continue;
            for (int h = start; loopOf.emplace(h, loops).second;)
                h = leaves.at(halfedges_.target(h));
            ++loops;
        }
        if (loops == 1) return true;
        if (loops == 0) return false;
        if (!fillHoles(found, starts)) return false;
    }
    return false;
}

bool Discs::fillHoles(std::vector<int>& found, const std::vector<int>& starts) {
    std::vector<char> seen(inside_.begin(), inside_.end());
    std::vector<std::vector<int>> pieces;
    for (const int start : starts) {
        const int seed = halfedges_.opposite(start) / 3;
        if (seen[std::size_t(seed)]) continue;
        seen[std::size_t(seed)] = 1;
        std::vector<int>& piece = pieces.emplace_back(1, seed);
        grow(piece, [&](int t) {
            if (seen[std::size_t(t)]) return false;
            seen[std::size_t(t)] = 1;
            return true;
        });
    }
    if (pieces.size() < 2) return false;
    const auto largest = std::ranges::max_element(
        pieces, [](const auto& a, const auto& b) { return a.size() < b.size(); });
    for (auto piece = pieces.begin(); piece != pieces.end(); ++piece) {
        if (piece == largest) continue;
        for (const int t : *piece) {
            inside_[std::size_t(t)] = 1;
            found.push_back(t);
        }
    }
    return true;
}

}  // namespace haustra::flatten
