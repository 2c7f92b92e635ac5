#include "render/scene/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haustra::render {

LensFrame lensFrame(const Camera& camera, double aspect) {
    const double halfAngle = glm::radians(0.5 * camera.fovDegrees);
    const double halfHeight = camera.lens == Lens::perspective ? std::tan(halfAngle)
                              : camera.lens == Lens::fisheye   ? halfAngle
                                                               : 0.5 * camera.heightMm;
    const glm::dvec3 ahead = glm::normalize(camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(ahead, camera.up));
    return {camera.lens, ahead, right * halfHeight * aspect, glm::cross(ahead, right) * halfHeight};
}

std::optional<LensRay> lensRay(const LensFrame& frame, glm::dvec2 place) {
    const glm::dvec3 aside = place.x * frame.right + place.y * frame.down;
    switch (frame.lens) {
        case Lens::perspective:
            return LensRay{glm::dvec3(0.0), glm::normalize(frame.ahead + aside)};
        case Lens::fisheye: {
            const double angle = glm::length(aside);
            if (angle > std::numbers::pi) return std::nullopt;
            return LensRay{glm::dvec3(0.0), std::cos(angle) * frame.ahead +
                                                std::sin(angle) / std::max(angle, 1e-9) * aside};
        }
        default:
            return LensRay{aside, frame.ahead};
    }
}

}  // namespace haustra::render
