#include "core/orbit.h"

#include <algorithm>
#include <cmath>

namespace haustra {

Camera cameraOf(const Orbit& orbit) {
    const double azimuth = glm::radians(orbit.azimuthDegrees);
    const double elevation = glm::radians(orbit.elevationDegrees);
    const glm::dvec3 outwards(std::sin(azimuth), -std::cos(azimuth), 0.0), head(0.0, 0.0, 1.0);
    Camera camera;
    camera.forward = -std::cos(elevation) * outwards - std::sin(elevation) * head;
    camera.up = std::cos(elevation) * head - std::sin(elevation) * outwards;
    camera.positionMm = orbit.centerMm - orbit.radiusMm * camera.forward;
    camera.lens = Lens::orthographic;
    camera.heightMm = orbit.heightMm;
    return camera;
}

glm::dvec3 projected(const Camera& orthographic, glm::dvec3 pointMm, glm::dvec2 size) {
    const double pixelsPerMm = size.y / orthographic.heightMm;
    const glm::dvec3 right = glm::cross(orthographic.forward, orthographic.up);
    const glm::dvec3 from = pointMm - orthographic.positionMm;
    return {0.5 * size.x + pixelsPerMm * glm::dot(from, right),
            0.5 * size.y - pixelsPerMm * glm::dot(from, orthographic.up),
            glm::dot(from, orthographic.forward)};
}

Orbit orbitAround(glm::dvec3 lowMm, glm::dvec3 highMm, double aspect) {
    const glm::dvec3 extent = highMm - lowMm;
    Orbit orbit;
    orbit.centerMm = 0.5 * (lowMm + highMm);
    orbit.radiusMm = std::max(1.5 * glm::length(extent), 1.0);
    // Seen from all around, the larger of the two extents across the patient's axis shows.
    const double high = std::max(extent.z, std::max(extent.x, extent.y) / aspect);
    orbit.heightMm = std::max(high * 12.0 / 10.0, 1.0);
    return orbit;
}

}  // namespace haustra
