// A polygon in the plane as convex pieces.
#pragma once

#include <array>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// The area of the parallelogram of a and b; positive where b is to the left of a.
inline double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

/// Counter-clockwise; two corners may be at one place.
using Trapezoid = std::array<glm::dvec2, 4>;

/// The inside of a closed polygon by the even–odd rule, cut at the heights of its corners and
/// crossings into trapezoids with horizontal sides that do not overlap. Fewer than three corners
/// have no inside. O(n²) in the corners, and in the pieces that come out.
std::vector<Trapezoid> evenOddTrapezoids(const std::vector<glm::dvec2>& polygon);

}  // namespace haustra
