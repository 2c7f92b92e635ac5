#include "render/scene/lens.h"

#include <cmath>

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

}  // namespace haustra::render
