// Masks of tubes around known curves: lumens whose centerline is given by a formula.
#pragma once

#include "core/volume.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::tests {

/// `count` points of curve(t), t from 0 to 1.
inline std::vector<glm::dvec3> sampleCurve(const std::function<glm::dvec3(double)>& curve,
                                           int count = 600) {
    std::vector<glm::dvec3> points;
    for (int n = 0; n < count; ++n)
        points.push_back(curve(double(n) / double(count - 1)));
    return points;
}

/// A grid that holds the points with `marginMm` around them.
inline Grid gridAround(const std::vector<glm::dvec3>& points, double marginMm,
                       glm::dvec3 spacingMm) {
    glm::dvec3 lo = points.front(), hi = points.front();
    for (const glm::dvec3& p : points)
        lo = glm::min(lo, p), hi = glm::max(hi, p);
    const glm::ivec3 size = glm::ivec3((hi - lo + 2.0 * marginMm) / spacingMm) + 1;
    return axisAlignedGrid(size, spacingMm, lo - marginMm);
}

/// Sets every voxel within `radiusMm` of one of the points; the points must lie densely.
inline void fillTube(Volume<std::uint8_t>& mask, const std::vector<glm::dvec3>& points,
                     double radiusMm, std::uint8_t label = 1) {
    const Grid& grid = mask.grid();
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    for (const glm::dvec3& p : points) {
        const glm::ivec3 center(glm::dvec3(voxelFromPatient * glm::dvec4(p, 1.0)));
        const glm::ivec3 reach = glm::ivec3(radiusMm / grid.spacingMm()) + 2;
        const glm::ivec3 lo = glm::max(center - reach, glm::ivec3(0));
        const glm::ivec3 hi = glm::min(center + reach, grid.size - 1);
        for (int k = lo.z; k <= hi.z; ++k) {
            for (int j = lo.y; j <= hi.y; ++j) {
                for (int i = lo.x; i <= hi.x; ++i) {
                    if (glm::distance(grid.patientFromVoxelPoint({i, j, k}), p) <= radiusMm) {
                        mask.writable()[grid.index(i, j, k)] = label;
                    }
                }
            }
        }
    }
}

/// Distance from a point to the polyline through `points`.
inline double distanceToCurve(const std::vector<glm::dvec3>& points, glm::dvec3 p) {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t n = 1; n < points.size(); ++n) {
        const glm::dvec3 chord = points[n] - points[n - 1];
        const double t =
            glm::clamp(glm::dot(p - points[n - 1], chord) / glm::dot(chord, chord), 0.0, 1.0);
        best = glm::min(best, glm::distance(p, points[n - 1] + t * chord));
    }
    return best;
}

}  // namespace haustra::tests
