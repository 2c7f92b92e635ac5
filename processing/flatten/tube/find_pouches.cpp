#include "core/flat_map.h"
#include "flatten/tube/cut_pouch.h"
#include "flatten/tube/flat_discs.h"
#include "flatten/tube/pouches.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace haustra::flatten {
namespace {

/// Borders that are less round than this leave a pouch too little of the hole.
constexpr double leastRoundness = 0.4;
/// A cluster of so many triangles is cut off before others, and these may lie in its pouch.
constexpr std::size_t largeSpot = 1000;
/// The least circle leaves a pouch of a hundred thousand triangles some hundred units of the
/// lattice for each.
constexpr double leastRadius = 0x1p-9, radiusStep = 1.1892071150027210667;

/// Spots that are nearer to each other than two of the least circles become one.
std::vector<Spot> merged(const TriMesh& tube, const PeriodicMap& map, std::vector<Spot> spots) {
    for (bool again = true; again;) {
        again = false;
        for (std::size_t a = 0; a < spots.size() && !again; ++a) {
            for (std::size_t b = a + 1; b < spots.size() && !again; ++b) {
                glm::dvec2 away = spots[b].middle - spots[a].middle;
                away.x -= std::round(away.x);
                if (glm::length(away) > 2.0 * leastRadius) continue;
                std::vector<int> both = std::move(spots[a].triangles);
                both.insert(both.end(), spots[b].triangles.begin(), spots[b].triangles.end());
                spots[a] = spotOf(tube, map, std::move(both));
                spots.erase(spots.begin() + std::ptrdiff_t(b));
                again = true;
            }
        }
    }
    return spots;
}

/// The radii from the least on that circles around `middle` may have, largest last.
std::vector<double> radiiFor(const PeriodicMap& map, const std::vector<Spot>& spots,
                             std::size_t spot) {
    const glm::dvec2 middle = spots[spot].middle;
    double most = largestRadiusAround(map, middle);
    for (std::size_t other = 0; other < spots.size(); ++other) {
        if (other == spot || (spots[spot].triangles.size() >= largeSpot &&
                              spots[other].triangles.size() < spots[spot].triangles.size()))
            continue;
        glm::dvec2 away = spots[other].middle - middle;
        away.x -= std::round(away.x);
        most = std::min(most, 0.5 * glm::length(away));
    }
    std::vector<double> radii;
    for (double radius = leastRadius; radius < most; radius *= radiusStep)
        radii.push_back(radius);
    return radii;
}

/// Radii by how well their circle cuts a finger off: by its length squared over the area within.
std::vector<double> neckFirst(const TriMesh& tube, const PeriodicMap& map, glm::dvec2 middle,
                              std::vector<double> radii) {
    std::vector<double> lengthMm(radii.size(), 0.0), within(radii.size(), 0.0);
    for (const glm::ivec3& t : tube.triangles) {
        double away[3];
        for (int c = 0; c < 3; ++c)
            away[c] = glm::distance(placeNear(map, t[c], middle), middle);
        const auto [least, most] = std::minmax({away[0], away[1], away[2]});
        if (radii.empty() || !(least < radii.back())) continue;
        for (std::size_t r = 0; r < radii.size(); ++r) {
            if (least >= radii[r]) continue;
            if (most < radii[r]) {
                within[r] += triangleAreaMm2(tube, t);
                continue;
            }
            glm::dvec3 ends[2];
            int found = 0;
            for (int c = 0; c < 3 && found < 2; ++c) {
                const double from = away[c], to = away[(c + 1) % 3];
                if ((from < radii[r]) == (to < radii[r])) continue;
                ends[found++] = glm::mix(tube.vertices[std::size_t(t[c])],
                                         tube.vertices[std::size_t(t[(c + 1) % 3])],
                                         (radii[r] - from) / (to - from));
            }
            if (found == 2) lengthMm[r] += glm::distance(ends[0], ends[1]);
        }
    }
    std::vector<std::size_t> order(radii.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const auto ratio = [&](std::size_t r) {
        return within[r] > 0.0 ? lengthMm[r] * lengthMm[r] / within[r]
                               : std::numeric_limits<double>::infinity();
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return ratio(a) < ratio(b); });
    std::vector<double> sorted;
    for (const std::size_t r : order)
        sorted.push_back(radii[r]);
    return sorted;
}

}  // namespace

std::vector<Pouch> findPouches(const TriMesh& tube, const PeriodicMap& map, double sideUnits) {
    const double least = sideUnits / flatUnitsPerCircumference(map.height);
    std::vector<int> crowded;
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        double longest = 0.0;
        for (int c = 0; c < 3; ++c) {
            longest = std::max(
                longest, glm::distance(map.corner(tube, t, c), map.corner(tube, t, (c + 1) % 3)));
        }
        if (!(longest >= least)) crowded.push_back(int(t));
    }
    if (crowded.empty()) return {};
    const auto halfedges = mesh::HalfedgeMesh::of(tube);
    if (!halfedges) return {};
    const VertexStars stars(tube);
    std::vector<Spot> spots;
    for (std::vector<int>& cluster : clustersOf(tube, stars, crowded))
        spots.push_back(spotOf(tube, map, std::move(cluster)));
    spots = merged(tube, map, std::move(spots));
    std::vector<Pouch> pouches;
    std::vector<char> taken(tube.triangles.size(), 0);
    Discs discs(tube, *halfedges, stars);
    std::vector<std::size_t> order(spots.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t n) {
        const std::size_t size = spots[n].triangles.size();
        return size < largeSpot ? 0 : size;
    });
    for (const std::size_t n : order) {
        const Spot& spot = spots[n];
        if (std::ranges::any_of(spot.triangles, [&](int t) { return taken[std::size_t(t)] != 0; }))
            continue;
        for (const double radius : neckFirst(tube, map, spot.middle, radiiFor(map, spots, n))) {
            auto pouch = discs.within(map, spot.triangles, spot.middle, radius, taken);
            if (!pouch) continue;
            std::vector<char> inside(tube.triangles.size(), 0);
            for (const int t : pouch->triangles)
                inside[std::size_t(t)] = 1;
            if (!(roundness(tube, *halfedges, map, inside, *pouch) > leastRoundness)) continue;
            for (const int t : pouch->triangles)
                taken[std::size_t(t)] = 1;
            pouches.push_back(std::move(*pouch));
            break;
        }
    }
    return pouches;
}

}  // namespace haustra::flatten
