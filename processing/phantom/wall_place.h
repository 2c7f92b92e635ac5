// Places on the colon's wall.
#pragma once

#include "phantom/colon_shape.h"

#include <optional>

namespace haustra::phantom {

struct WallPlace {
    glm::dvec3 at{0.0};           ///< on the lumen's boundary
    glm::dvec3 inward{0, 0, 1};   ///< unit, into the lumen
    glm::dvec3 tangent{1, 0, 0};  ///< unit, along the wall
    double arcMm = 0.0;
    double radiusMm = 0.0;  ///< of the colon there
};

/// Walks from the axis along a direction across it (`angle` from the first taenia, radians) to
/// where the lumen ends: wall or fold. Nothing where the lumen is narrow, or the walk ends on an
/// edge.
std::optional<WallPlace> castToWall(const ColonShape& shape, double arcMm, double angle);

}  // namespace haustra::phantom
