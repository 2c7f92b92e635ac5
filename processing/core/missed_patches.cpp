#include "core/missed_patches.h"

#include "core/triangle_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <tuple>

namespace haustra {
namespace {

/// The wall around a patch's centre whose direction is the centre's.
constexpr double aroundMm = 3.0;

glm::dvec3 corner(const TriMesh& wall, int triangle, int n) {
    return wall.vertices[std::size_t(wall.triangles[std::size_t(triangle)][n])];
}

glm::dvec3 middleOf(const TriMesh& wall, int triangle) {
    return (corner(wall, triangle, 0) + corner(wall, triangle, 1) + corner(wall, triangle, 2)) /
           3.0;
}

/// Into the lumen; its length is twice the area.
glm::dvec3 inwardOf(const TriMesh& wall, int triangle) {
    const glm::dvec3 a = corner(wall, triangle, 0);
    return glm::cross(corner(wall, triangle, 2) - a, corner(wall, triangle, 1) - a);
}

/// Of each vertex the first at its place.
std::vector<std::int32_t> firstAtPlace(const std::vector<glm::dvec3>& vertices) {
    std::vector<std::int32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0);
    const auto place = [&](std::int32_t n) {
        const glm::dvec3& v = vertices[std::size_t(n)];
        return std::array{v.x, v.y, v.z};
    };
    std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
        const auto pa = place(a), pb = place(b);
        return pa != pb ? pa < pb : a < b;
    });
    std::vector<std::int32_t> first(vertices.size());
    for (std::size_t n = 0; n < order.size(); ++n)
        first[std::size_t(order[n])] = n > 0 && place(order[n]) == place(order[n - 1])
                                           ? first[std::size_t(order[n - 1])]
                                           : order[n];
    return first;
}

// Of the samples on the wall's inner side: another loop that lies against this wall has its own
// nearer ones, but behind it. In the cecum's end all may lie behind; the next inner one is then
// farther than the axis of any colon from its wall (a cecum of 120 mm is near to bursting), and
// the nearest of all counts.
double arcOf(const Centerline& centerline, glm::dvec3 centerMm, glm::dvec3 inward) {
    constexpr double widestRadiusMm = 60.0;
    const double infinity = std::numeric_limits<double>::infinity();
    double nearest = infinity, inner = infinity, arc = 0.0, innerArc = 0.0;
    for (const CenterlinePoint& sample : centerline.points) {
        const glm::dvec3 from = sample.positionMm - centerMm;
        const double mm = glm::length(from);
        if (mm < nearest) nearest = mm, arc = sample.arcMm;
        if (mm < inner && glm::dot(from, inward) > 0.0) inner = mm, innerArc = sample.arcMm;
    }
    return inner <= widestRadiusMm ? innerArc : arc;
}

/// What remains to know of a patch whose triangles and area are known.
void complete(const TriMesh& wall, const Centerline& centerline, MissedPatch& patch) {
    glm::dvec3 mean(0.0), middles(0.0);
    for (const std::int32_t triangle : patch.triangles) {
        const double area = 0.5 * glm::length(inwardOf(wall, triangle));
        mean += area * middleOf(wall, triangle);
        middles += middleOf(wall, triangle);
    }
    mean = patch.areaMm2 > 0.0 ? mean / patch.areaMm2 : middles / double(patch.triangles.size());
    double best = std::numeric_limits<double>::infinity();
    for (const std::int32_t triangle : patch.triangles) {
        const glm::dvec3 a = corner(wall, triangle, 0), b = corner(wall, triangle, 1),
                         c = corner(wall, triangle, 2);
        const glm::dvec3 w = nearestInTriangle(mean, a, b, c);
        const glm::dvec3 place = w.x * a + w.y * b + w.z * c;
        const double squared = glm::dot(place - mean, place - mean);
        if (squared < best) best = squared, patch.centerMm = place, patch.centerTriangle = triangle;
    }
    for (const std::int32_t triangle : patch.triangles)
        if (triangle == patch.centerTriangle ||
            glm::distance(middleOf(wall, triangle), patch.centerMm) < aroundMm)
            patch.inward += inwardOf(wall, triangle);
    const double length = glm::length(patch.inward);
    if (length > 0.0) patch.inward /= length;
    if (!centerline.points.empty()) patch.arcMm = arcOf(centerline, patch.centerMm, patch.inward);
}

bool isBridge(std::span<const std::uint8_t> bridged, std::size_t triangle) {
    return !bridged.empty() && bridged[triangle] != 0;
}

}  // namespace

std::vector<glm::ivec3> neighboursOf(const TriMesh& wall) {
    const auto first = firstAtPlace(wall.vertices);
    struct Edge {
        std::int32_t low, high, side;  // side: 3 · triangle + edge
    };
    std::vector<Edge> edges;
    edges.reserve(3 * wall.triangles.size());
    for (std::size_t t = 0; t < wall.triangles.size(); ++t) {
        for (int n = 0; n < 3; ++n) {
            const std::int32_t a = first[std::size_t(wall.triangles[t][n])],
                               b = first[std::size_t(wall.triangles[t][(n + 1) % 3])];
            if (a != b) edges.push_back({std::min(a, b), std::max(a, b), std::int32_t(3 * t) + n});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::tie(a.low, a.high, a.side) < std::tie(b.low, b.high, b.side);
    });
    std::vector<glm::ivec3> neighbours(wall.triangles.size(), glm::ivec3(-1));
    for (std::size_t n = 0; n + 1 < edges.size(); ++n) {
        const Edge &a = edges[n], &b = edges[n + 1];
        if (a.low != b.low || a.high != b.high) continue;
        neighbours[std::size_t(a.side / 3)][a.side % 3] = b.side / 3;
        neighbours[std::size_t(b.side / 3)][b.side % 3] = a.side / 3;
        ++n;
    }
    return neighbours;
}

std::vector<std::uint8_t> withoutSingles(std::span<const glm::ivec3> neighbours,
                                         std::span<const std::uint8_t> seen,
                                         std::span<const std::uint8_t> bridged) {
    std::vector<std::uint8_t> counts(seen.size(), 0);
    for (std::size_t t = 0; t < seen.size(); ++t) {
        if (isBridge(bridged, t)) continue;
        int unseenAround = 0, seenAround = 0;
        for (int n = 0; n < 3; ++n) {
            const int other = neighbours[t][n];
            if (other < 0 || isBridge(bridged, std::size_t(other))) continue;
            ++(seen[std::size_t(other)] ? seenAround : unseenAround);
        }
        counts[t] = seen[t] || (unseenAround == 0 && seenAround > 0);
    }
    return counts;
}

std::vector<MissedPatch> missedPatches(const TriMesh& wall, std::span<const glm::ivec3> neighbours,
                                       std::span<const std::uint8_t> seen,
                                       std::span<const std::uint8_t> bridged,
                                       const Centerline& centerline, double leastMm2) {
    std::vector<std::uint8_t> taken = withoutSingles(neighbours, seen, bridged);
    std::vector<MissedPatch> patches;
    for (std::size_t start = 0; start < taken.size(); ++start) {
        if (taken[start] || isBridge(bridged, start)) continue;
        MissedPatch patch;
        patch.triangles = {std::int32_t(start)};
        taken[start] = 1;
        for (std::size_t n = 0; n < patch.triangles.size(); ++n) {
            for (int side = 0; side < 3; ++side) {
                const int other = neighbours[std::size_t(patch.triangles[n])][side];
                if (other < 0 || taken[std::size_t(other)] || isBridge(bridged, std::size_t(other)))
                    continue;
                taken[std::size_t(other)] = 1;
                patch.triangles.push_back(other);
            }
        }
        std::sort(patch.triangles.begin(), patch.triangles.end());
        for (const std::int32_t triangle : patch.triangles)
            patch.areaMm2 += 0.5 * glm::length(inwardOf(wall, triangle));
        if (patch.areaMm2 < leastMm2) continue;
        complete(wall, centerline, patch);
        patches.push_back(std::move(patch));
    }
    std::stable_sort(
        patches.begin(), patches.end(),
        [](const MissedPatch& a, const MissedPatch& b) { return a.areaMm2 > b.areaMm2; });
    return patches;
}

}  // namespace haustra
