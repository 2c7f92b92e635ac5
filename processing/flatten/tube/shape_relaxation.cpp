#include "flatten/tube/shape_relaxation.h"

#include "flatten/triangle_stretch.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace haustra::flatten {
namespace {

/// Of one triangle, as its corner moves and the side across from it stays.
struct CornerEnergy {
    glm::dvec2 first,
        second;  ///< the side's ends, counter-clockwise, from the corner's first place
    double cotFirst, cotSecond, cotCorner;
};

/// Value, gradient and Hessian of a sum of N/D, N = ½ Σ cot·|side|² and D the flat area: K + 1/K.
struct Newton {
    double value = 0.0;
    glm::dvec2 gradient{0.0};
    glm::dmat2 hessian{0.0};
};

double cotangentAt(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 p = b - a, q = c - a;
    return glm::dot(p, q) / glm::length(glm::cross(p, q));
}

/// Nothing where a triangle is flipped with the corner at z.
std::optional<Newton> energyAt(const std::vector<CornerEnergy>& star, const glm::dvec2& z) {
    Newton sum;
    for (const CornerEnergy& t : star) {
        const glm::dvec2 p = t.first - z, q = t.second - z, side = t.second - t.first;
        const double area = 0.5 * (p.x * q.y - p.y * q.x);
        if (!(area > 0.0)) return std::nullopt;
        const double stretch = 0.5 * (t.cotSecond * glm::dot(p, p) + t.cotFirst * glm::dot(q, q) +
                                      t.cotCorner * glm::dot(side, side));
        const glm::dvec2 dStretch = -t.cotSecond * p - t.cotFirst * q;
        const glm::dvec2 dArea = 0.5 * glm::dvec2(-side.y, side.x);
        sum.value += stretch / area;
        sum.gradient += (dStretch - stretch / area * dArea) / area;
        const double curve = (t.cotFirst + t.cotSecond) / area;
        sum.hessian += glm::dmat2(curve) -
                       (glm::outerProduct(dStretch, dArea) + glm::outerProduct(dArea, dStretch)) /
                           (area * area) +
                       glm::outerProduct(dArea, dArea) * (2.0 * stretch / (area * area * area));
    }
    return sum;
}

/// Moves z along `step`, or a part of it, to where the energy is lower; false where it is not.
bool descend(const std::vector<CornerEnergy>& star, const glm::dvec2& step, int halvings,
             glm::dvec2& z, Newton& here) {
    if (!std::isfinite(step.x) || !std::isfinite(step.y)) return false;
    double share = 1.0;
    for (int n = 0; n < halvings; ++n, share *= 0.5) {
        const auto there = energyAt(star, z + share * step);
        if (!there || !(there->value < here.value)) continue;
        z += share * step;
        here = *there;
        return true;
    }
    return false;
}

/// How far to move the corner that all of `star` share.
glm::dvec2 bestStep(const std::vector<CornerEnergy>& star) {
    glm::dvec2 z(0.0);
    auto here = energyAt(star, z);
    if (!here) return z;
    double reach = 0.0;
    for (const CornerEnergy& t : star)
        reach = std::max(reach, glm::length(t.first));
    for (int iteration = 0; iteration < 4; ++iteration) {
        const glm::dvec2 newton = -(glm::inverse(here->hessian) * here->gradient);
        if (descend(star, newton, 8, z, *here)) continue;
        // Rounding spoils the Hessian where a triangle has next to no area.
        const glm::dvec2 downhill = -reach * here->gradient / glm::length(here->gradient);
        if (!descend(star, downhill, 30, z, *here)) break;
    }
    return z;
}

}  // namespace

std::vector<int> stretchedVertices(const PeriodicMap& map, const TriMesh& tube,
                                   const VertexStars& stars, double most) {
    std::vector<int> found;
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        const glm::dvec2 at = map.corner(tube, t, 0);
        const auto side = [&](int c) {
            return tube.vertices[std::size_t(tube.triangles[t][c])] -
                   tube.vertices[std::size_t(tube.triangles[t][0])];
        };
        // A triangle without area on the surface has no shape to keep.
        if (!(dilatation(side(1), side(2), map.corner(tube, t, 1) - at,
                         map.corner(tube, t, 2) - at) > most))
            continue;
        for (int c = 0; c < 3; ++c) {
            for (const int corner : stars.of(tube.triangles[t][c])) {
                for (int n = 0; n < 3; ++n)
                    found.push_back(tube.triangles[std::size_t(corner / 3)][n]);
            }
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::erase_if(found, [&](int v) {
        const double y = map.flat[std::size_t(v)].y;
        return y == 0.0 || y == map.height;
    });
    return found;
}

void relaxShapes(PeriodicMap& map, const TriMesh& tube, const VertexStars& stars,
                 const std::vector<int>& vertices, int sweeps) {
    std::vector<CornerEnergy> star;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (const int v : vertices) {
            star.clear();
            for (const int corner : stars.of(v)) {
                const auto t = std::size_t(corner / 3);
                const int here = corner % 3, next = (here + 1) % 3, last = (here + 2) % 3;
                const glm::dvec2 at = map.corner(tube, t, here);
                const auto place = [&](int c) {
                    return tube.vertices[std::size_t(tube.triangles[t][c])];
                };
                star.push_back({map.corner(tube, t, next) - at, map.corner(tube, t, last) - at,
                                cotangentAt(place(next), place(last), place(here)),
                                cotangentAt(place(last), place(here), place(next)),
                                cotangentAt(place(here), place(next), place(last))});
            }
            map.flat[std::size_t(v)] += bestStep(star);
        }
    }
}

}  // namespace haustra::flatten
