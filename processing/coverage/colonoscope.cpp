#include "coverage/colonoscope.h"

#include <cmath>

namespace haustra::coverage {

Colonoscope olympusCfQ160l() {
    return {.name = "Olympus CF-Q160L",
            .lens = {{13.5747, -2.2982, 0.0, 0.0}, 25.5903, 25.6000, 274.2596, 220.6445},
            .pictureSize = {525, 440},
            .openCenter = {267.05, 215.01},
            .openRadii = {309.08, 294.92},
            .fieldDegrees = 140.0,
            .nearestMm = 3.0,
            .farthestMm = 100.0,
            .tipRadiusMm = 6.4};
}

std::optional<glm::dvec3> directionOf(const Colonoscope& scope, glm::dvec2 pixel) {
    const glm::dvec2 within = (pixel - scope.openCenter) / scope.openRadii;
    if (glm::dot(within, within) > 1.0) return std::nullopt;
    const auto direction = directionOf(scope.lens, pixel);
    if (!direction || direction->z < std::cos(glm::radians(0.5 * scope.fieldDegrees)))
        return std::nullopt;
    return direction;
}

}  // namespace haustra::coverage
