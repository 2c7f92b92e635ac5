#include "phantom/truth.h"

#include "core/parallel.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <cmath>

namespace haustra::phantom {

Centerline trueCenterline(const ColonShape& shape, const Volume<std::uint8_t>& lumen, int threads) {
    const Grid& grid = lumen.grid();
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const glm::dvec3 spacing = grid.spacingMm();
    const ColonPath& path = shape.path();
    Centerline line;
    line.points.resize(path.samples.size());
    parallelFor(line.points.size(), 16, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            CenterlinePoint& point = line.points[n];
            point.positionMm = path.samples[n].position;
            point.arcMm = path.stepMm * double(n);
            const glm::dvec3 at(voxelFromPatient * glm::dvec4(point.positionMm, 1.0));
            const glm::ivec3 center(glm::round(at));
            point.gap = !grid.contains(center) || lumen.at(center) == 0;
            if (point.gap) continue;
            // The axis is nowhere farther from the wall than the sacculated tube is wide.
            const double farthest = 1.3 * std::max(path.samples[n].radiusMm, 5.0) + 4.0;
            const glm::ivec3 reach(glm::ceil(farthest / spacing));
            const glm::ivec3 lo = glm::max(center - reach, glm::ivec3(0)),
                             hi = glm::min(center + reach, grid.size - 1);
            double nearest = farthest * farthest;
            visitBox(lo, hi, [&](glm::ivec3 v) {
                if (lumen.at(v)) return;
                const glm::dvec3 d = (glm::dvec3(v) - at) * spacing;
                nearest = std::min(nearest, glm::dot(d, d));
            });
            point.radiusMm = std::sqrt(nearest);
        }
    });
    return line;
}

std::vector<std::vector<std::uint32_t>> polypVoxels(const ColonShape& shape, const Grid& grid) {
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    std::vector<std::vector<std::uint32_t>> all;
    for (const Growth& growth : shape.growths()) {
        if (!growth.polyp()) continue;
        auto& voxels = all.emplace_back();
        ColonShape::Nearby nearby;
        shape.findNearby(growth.center, growth.reachMm(), nearby);
        nearby.growths.clear();  // the bare tube with its folds
        const glm::dvec3 middle(voxelFromPatient * glm::dvec4(growth.center, 1.0));
        const glm::dvec3 reach = growth.reachMm() / grid.spacingMm();
        const glm::ivec3 lo = glm::max(glm::ivec3(glm::ceil(middle - reach)), glm::ivec3(0)),
                         hi = glm::min(glm::ivec3(glm::floor(middle + reach)), grid.size - 1);
        visitBox(lo, hi, [&](glm::ivec3 v) {
            const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(v));
            if (growth.distance(p) < 0.0 && shape.evaluate(p, nearby).lumenMm < 0.0)
                voxels.push_back(std::uint32_t(grid.index(v)));
        });
    }
    return all;
}

}  // namespace haustra::phantom
