#include "flatten/flip_repair.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::flatten {
namespace {

constexpr int kMostRings = 12;
constexpr int kSweepsPerRing = 30;

double twiceArea(const PeriodicMap& map, const TriMesh& tube, std::size_t t) {
    const glm::dvec2 at = map.corner(tube, t, 0);
    const glm::dvec2 a = map.corner(tube, t, 1) - at, b = map.corner(tube, t, 2) - at;
    return a.x * b.y - a.y * b.x;
}

/// The triangles around each vertex, as 3·triangle + corner.
class Stars {
public:
    explicit Stars(const TriMesh& tube) : first_(tube.vertices.size() + 1, 0) {
        for (const glm::ivec3& t : tube.triangles) {
            for (int c = 0; c < 3; ++c)
                ++first_[std::size_t(t[c]) + 1];
        }
        for (std::size_t v = 1; v < first_.size(); ++v)
            first_[v] += first_[v - 1];
        corners_.resize(tube.triangles.size() * 3);
        std::vector<int> next(first_.begin(), first_.end() - 1);
        for (std::size_t n = 0; n < corners_.size(); ++n)
            corners_[std::size_t(next[std::size_t(tube.triangles[n / 3][int(n % 3)])]++)] = int(n);
    }
    const int* begin(int v) const { return corners_.data() + first_[std::size_t(v)]; }
    const int* end(int v) const { return corners_.data() + first_[std::size_t(v) + 1]; }

private:
    std::vector<int> first_, corners_;
};

/// tan of half the angle at a between b and c, finite.
double halfTangent(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 p = b - a, q = c - a;
    const double sine = glm::length(glm::cross(p, q)), cosine = glm::dot(p, q);
    const double full = std::sqrt(glm::dot(p, p) * glm::dot(q, q));
    return sine > 1e-9 * full ? (full - cosine) / sine : (cosine > 0.0 ? 1e-9 : 1e9);
}

class Repair {
public:
    Repair(PeriodicMap& map, const TriMesh& tube) : map_(map), tube_(tube), stars_(tube) {}

    int run(std::vector<int> flipped) {
        const PeriodicMap before = map_;
        const std::size_t flipsBefore = flipped.size();
        std::vector<int> patch;
        for (int ring = 0; ring < kMostRings && !flipped.empty(); ++ring) {
            for (const int t : flipped) {
                for (int c = 0; c < 3; ++c)
                    patch.push_back(tube_.triangles[std::size_t(t)][c]);
            }
            if (ring > 0) patch = withNeighbours(patch);
            std::sort(patch.begin(), patch.end());
            patch.erase(std::unique(patch.begin(), patch.end()), patch.end());
            for (int sweep = 0; sweep < kSweepsPerRing; ++sweep) {
                for (const int v : patch)
                    relax(v);
            }
            flipped = flippedTriangles(map_, tube_);
        }
        if (flipped.size() > flipsBefore) {
            map_ = before;
            return 0;
        }
        rotate(map_, tube_, 0.0);
        return int(patch.size());
    }

private:
    std::vector<int> withNeighbours(std::vector<int> patch) const {
        const std::size_t count = patch.size();
        for (std::size_t n = 0; n < count; ++n) {
            for (const int* corner = stars_.begin(patch[n]); corner != stars_.end(patch[n]);
                 ++corner) {
                for (int c = 0; c < 3; ++c)
                    patch.push_back(tube_.triangles[std::size_t(*corner / 3)][c]);
            }
        }
        return patch;
    }

    void relax(int v) {
        const double y = map_.flat[std::size_t(v)].y;
        glm::dvec2 sum(0.0);
        double weights = 0.0;
        for (const int* n = stars_.begin(v); n != stars_.end(v); ++n) {
            const auto t = std::size_t(*n / 3);
            const int c = *n % 3;
            const glm::dvec3& at = tube_.vertices[std::size_t(v)];
            const glm::dvec2 flat = map_.corner(tube_, t, c);
            const int others[2] = {(c + 1) % 3, (c + 2) % 3};
            const glm::dvec3& p = tube_.vertices[std::size_t(tube_.triangles[t][others[0]])];
            const glm::dvec3& q = tube_.vertices[std::size_t(tube_.triangles[t][others[1]])];
            const double tangent = halfTangent(at, p, q);
            for (const int other : others) {
                const glm::dvec3& far = tube_.vertices[std::size_t(tube_.triangles[t][other])];
                const double weight = tangent / std::max(glm::distance(at, far), 1e-9);
                sum += weight * (map_.corner(tube_, t, other) - flat);
                weights += weight;
            }
        }
        if (!(weights > 0.0)) return;
        const bool onRim = y == 0.0 || y == map_.height;
        map_.flat[std::size_t(v)].x += sum.x / weights;
        if (!onRim) map_.flat[std::size_t(v)].y += sum.y / weights;
    }

    PeriodicMap& map_;
    const TriMesh& tube_;
    Stars stars_;
};

}  // namespace

std::vector<int> flippedTriangles(const PeriodicMap& map, const TriMesh& tube) {
    std::vector<int> flipped;
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        if (!(twiceArea(map, tube, t) > 0.0)) flipped.push_back(int(t));
    }
    return flipped;
}

int repairFlips(PeriodicMap& map, const TriMesh& tube) {
    std::vector<int> flipped = flippedTriangles(map, tube);
    return flipped.empty() ? 0 : Repair(map, tube).run(std::move(flipped));
}

}  // namespace haustra::flatten
