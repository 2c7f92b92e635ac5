// Small pieces of implicit geometry: signed distances in mm, negative inside.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

namespace haustra::phantom {

/// Approximate signed distance to an ellipsoid (exact for a sphere; first order elsewhere).
inline double ellipsoid(glm::dvec3 p, glm::dvec3 center, glm::dvec3 semiAxes) {
    const glm::dvec3 q = (p - center) / semiAxes;
    const double k0 = glm::length(q), k1 = glm::length(q / semiAxes);
    return k1 > 1e-9 ? k0 * (k0 - 1.0) / k1 : -std::min({semiAxes.x, semiAxes.y, semiAxes.z});
}

inline double capsule(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, double radius) {
    const glm::dvec3 ab = b - a, ap = p - a;
    const double t = std::clamp(glm::dot(ap, ab) / std::max(1e-12, glm::dot(ab, ab)), 0.0, 1.0);
    return glm::length(ap - t * ab) - radius;
}

/// Maximum with a rounded crease of width `k` mm (polynomial; equal to max where |a − b| ≥ k).
inline double smoothMax(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::max(a, b) + h * h * k * 0.25;
}

/// The share of a voxel of width `widthMm` that lies inside a surface at signed distance `d`.
inline double coverage(double d, double widthMm) {
    return std::clamp(0.5 - d / widthMm, 0.0, 1.0);
}

inline double smoothstep(double lo, double hi, double x) {
    const double t = std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

}  // namespace haustra::phantom
