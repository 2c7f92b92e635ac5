// Discs of a tube by where its map has them.
#pragma once

#include "flatten/tube/flat_places.h"
#include "flatten/tube/pouches.h"
#include "mesh/halfedge_mesh.h"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <vector>

namespace haustra::flatten {

/// Discs of the surface that a circle in the plane encloses.
class Discs {
public:
    Discs(const TriMesh& tube, const mesh::HalfedgeMesh& halfedges, const VertexStars& stars)
        : tube_(tube), halfedges_(halfedges), stars_(stars), inside_(tube.triangles.size(), 0) {}

    /// The triangles within the circle that hang together with one of `seeds`, which must be among
    /// them, with what they enclose; nothing where these are no disc with a border that is seen
    /// from a point within, or are already `taken`.
    std::optional<Pouch> within(const PeriodicMap& map, const std::vector<int>& seeds,
                                glm::dvec2 middle, double radius, const std::vector<char>& taken) {
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
        const auto add = [&](int t) {
            if (inside_[std::size_t(t)]) return;
            inside_[std::size_t(t)] = 1;
            found.push_back(t);
        };
        for (const int seed : seeds) {
            if (isWithin(seed)) add(seed);
        }
        for (std::size_t n = 0; n < found.size(); ++n) {
            for (int c = 0; c < 3; ++c) {
                const int other = halfedges_.opposite(3 * found[n] + c);
                if (other >= 0 && !inside_[std::size_t(other / 3)] && isWithin(other / 3))
                    add(other / 3);
            }
        }
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

private:
    bool isBorder(int h) const {
        const int other = halfedges_.opposite(h);
        return other < 0 || !inside_[std::size_t(other / 3)];
    }

    /// Adds what the triangles enclose, and what they meet at a vertex alone; false where they
    /// still are no disc.
    bool close(std::vector<int>& found) {
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

    /// Of the pieces that the triangles leave, all but the largest join them.
    bool fillHoles(std::vector<int>& found, const std::vector<int>& starts) {
        std::vector<char> seen(inside_.begin(), inside_.end());
        std::vector<std::vector<int>> pieces;
        for (const int start : starts) {
            const int seed = halfedges_.opposite(start) / 3;
            if (seen[std::size_t(seed)]) continue;
            seen[std::size_t(seed)] = 1;
            std::vector<int>& piece = pieces.emplace_back(1, seed);
            for (std::size_t n = 0; n < piece.size(); ++n) {
                for (int c = 0; c < 3; ++c) {
                    const int other = halfedges_.opposite(3 * piece[n] + c);
                    if (other < 0 || seen[std::size_t(other / 3)]) continue;
                    seen[std::size_t(other / 3)] = 1;
                    piece.push_back(other / 3);
                }
            }
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

    const TriMesh& tube_;
    const mesh::HalfedgeMesh& halfedges_;
    const VertexStars& stars_;
    std::vector<char> inside_;
};

}  // namespace haustra::flatten
