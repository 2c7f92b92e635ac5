#include "core/camera.h"

#include <cmath>
#include <numbers>

namespace haustra {

bool isFinite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Result<void> checkCamera(const Camera& camera) {
    if (!isFinite(camera.positionMm) || !isFinite(camera.forward) || !isFinite(camera.up))
        return fail(ErrorKind::badInput, "a coordinate is not a finite number", "camera");
    const double widest = camera.lens == Lens::fisheye ? 360.0 : 170.0;
    if (camera.lens != Lens::orthographic &&
        !(camera.fovDegrees >= 1.0 && camera.fovDegrees <= widest))
        return fail(
            ErrorKind::badInput,
            "the field of view is not within 1 to " + std::to_string(int(widest)) + " degrees",
            "camera");
    if (camera.lens == Lens::orthographic && !(camera.heightMm > 0.0 && camera.heightMm <= 1e6))
        return fail(ErrorKind::badInput, "the picture's height is not within 0 to 1000000 mm",
                    "camera");
    const double lengths = glm::length(camera.forward) * glm::length(camera.up);
    if (!std::isfinite(lengths) ||
        !(glm::length(glm::cross(camera.forward, camera.up)) > 1e-6 * lengths))
        return fail(ErrorKind::badInput, "the forward and up directions are zero or parallel",
                    "camera");
    return {};
}

std::optional<glm::dvec3> rayThrough(const Camera& camera, glm::dvec2 heightsFromMiddle) {
    const glm::dvec3 ahead = glm::normalize(camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(ahead, camera.up));
    const glm::dvec3 down = glm::cross(ahead, right);
    const glm::dvec3 aside = 2.0 * (heightsFromMiddle.x * right + heightsFromMiddle.y * down);
    const double half = glm::radians(0.5 * camera.fovDegrees), length = glm::length(aside);
    if (camera.lens == Lens::perspective) return glm::normalize(ahead + std::tan(half) * aside);
    if (camera.lens == Lens::orthographic || half * length > std::numbers::pi) return std::nullopt;
    if (length == 0.0) return ahead;
    return std::cos(half * length) * ahead + std::sin(half * length) / length * aside;
}

}  // namespace haustra
