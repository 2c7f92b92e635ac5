// How far a flat map is from keeping angles and areas.
#pragma once

#include "core/tri_mesh.h"

#include <cstddef>
#include <functional>

namespace haustra::flatten {

struct Spread {
    double mean = 0.0, p95 = 0.0, p999 = 0.0, max = 0.0;
};

struct Distortion {
    Spread angleErrorDegrees;  ///< |flat angle − angle| over all corners
    /// No piecewise linear map has a lower mean: Σ |2π − angle sum| over interior vertices /
    /// corners.
    double angleFloorDegrees = 0.0;
    Spread dilatation;              ///< largest over smallest stretch of each triangle, ≥ 1
    double logAreaDeviation = 0.0;  ///< standard deviation of ln(flat area / area), area-weighted
    double areaRange = 0.0;         ///< 99.9 % over 0.1 % of flat area / area, area-weighted
    std::size_t flips = 0;          ///< triangles of no or negative flat area
};

/// `cornerAt(triangle, corner)` is the flat place of a corner. Triangles of no area on the surface
/// are left out of angles and dilatation, those of no flat area out of dilatation. O(n log n),
/// deterministic, one thread.
Distortion measureDistortion(const TriMesh& mesh,
                             const std::function<glm::dvec2(std::size_t, int)>& cornerAt);

}  // namespace haustra::flatten
