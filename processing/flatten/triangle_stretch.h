// What the linear map of one triangle into the plane does to its shape.
#pragma once

#include <cmath>
#include <limits>

#include <glm/glm.hpp>

namespace haustra::flatten {

/// Largest over smallest stretch, ≥ 1, of the map from the triangle with sides a and b in space to
/// that with sides p and q in the plane, whichever way that one turns. Infinite where the flat one
/// has no area; the one in space must have some.
inline double dilatation(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec2& p,
                         const glm::dvec2& q) {
    const double length = glm::length(a);
    const double bx = glm::dot(a, b) / length, by = glm::length(glm::cross(a, b)) / length;
    const glm::dvec2 jx = p / length, jy = (q - jx * bx) / by;
    // The singular values are the sum and the difference of the parts that keep and that mirror
    // angles; their product is the determinant.
    const double keeps = std::hypot(jx.x + jy.y, jx.y - jy.x);
    const double mirrors = std::hypot(jx.x - jy.y, jx.y + jy.x);
    const double most = keeps + mirrors, product = 4.0 * std::abs(jx.x * jy.y - jx.y * jy.x);
    return product > 0.0 ? most * most / product : std::numeric_limits<double>::infinity();
}

}  // namespace haustra::flatten
