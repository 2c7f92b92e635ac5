#include "core/bridges.h"

#include "core/ct_scan.h"

#include <algorithm>

namespace haustra {

std::vector<Bridge> bridgesOf(const Centerline& centerline) {
    const std::vector<CenterlinePoint>& points = centerline.points;
    std::vector<Bridge> bridges;
    for (std::size_t n = 0; n < points.size(); ++n) {
        if (!points[n].gap) continue;
        std::size_t last = n;
        while (last + 1 < points.size() && points[last + 1].gap)
            ++last;
        const auto between = [&](std::size_t a, std::size_t b) {
            return 0.5 * (points[a].arcMm + points[b].arcMm);
        };
        bridges.push_back(
            {n > 0 ? between(n - 1, n) : points[n].arcMm,
             last + 1 < points.size() ? between(last, last + 1) : points[last].arcMm});
        n = last;
    }
    return bridges;
}

std::vector<std::uint8_t> bridgedTriangles(const TriMesh& wall, const Volume<std::uint8_t>& lumen) {
    const Grid& grid = lumen.grid();
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const glm::dvec3 spacing = grid.spacingMm();
    const double stepMm = 0.25 * std::min({spacing.x, spacing.y, spacing.z}),
                 deepestMm = 2.0 * std::max({spacing.x, spacing.y, spacing.z});
    std::vector<std::uint8_t> bridged(wall.triangles.size(), 0);
    for (std::size_t n = 0; n < bridged.size(); ++n) {
        const glm::ivec3 t = wall.triangles[n];
        const glm::dvec3 a = wall.vertices[std::size_t(t.x)], b = wall.vertices[std::size_t(t.y)],
                         c = wall.vertices[std::size_t(t.z)];
        const glm::dvec3 outward = glm::cross(b - a, c - a);
        const double doubled = glm::length(outward);
        const glm::dvec3 inward = doubled > 0.0 ? -outward / doubled : glm::dvec3(0.0);
        for (double depth = 0.0; depth <= deepestMm; depth += stepMm) {
            const glm::dvec3 at = (a + b + c) / 3.0 + depth * inward;
            const glm::dvec3 voxel(voxelFromPatient * glm::dvec4(at, 1.0));
            const glm::ivec3 nearest(glm::floor(voxel + 0.5));
            if (!grid.contains(nearest)) continue;
            const auto label = LumenLabel(lumen.at(nearest));
            if (label == LumenLabel::outside) continue;
            bridged[n] = label == LumenLabel::bridge;
            break;
        }
    }
    return bridged;
}

}  // namespace haustra
