// Points of a patient that can be meant.
#pragma once

#include <cmath>

#include <glm/glm.hpp>

namespace haustra {

/// Of each coordinate of a patient point, either way: far beyond any scan, and little enough for
/// what is computed from it.
inline constexpr double maxCoordinateMm = 1e6;

/// Whether each coordinate is a number of at most maxCoordinateMm.
inline bool isPatientPoint(glm::dvec3 mm) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(mm[axis]) <= maxCoordinateMm)) return false;
    return true;
}

}  // namespace haustra
