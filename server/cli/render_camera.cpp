#include "cli/render_camera.h"

#include "core/orbit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::cli {

namespace {

constexpr double marginShare = 1.04;

}  // namespace

Camera cameraOutside(const Grid& grid, Direction from, Lens lens, double fovDegrees,
                     double aspect) {
    const Camera pose = cameraOf({{}, 1.0, from.azimuthDegrees, from.elevationDegrees, 1.0});
    const glm::dvec3 right = glm::cross(pose.forward, pose.up);
    const glm::dvec3 faces(grid.size);
    const glm::dvec3 middle = grid.patientFromVoxelPoint(0.5 * faces - 0.5);
    // A fisheye sees no less than a perspective does of what is within its middle.
    const double slope = std::tan(glm::radians(0.5 * std::min(fovDegrees, 120.0)));
    double distance = 0.0, halfHeight = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
        const glm::dvec3 mm = grid.patientFromVoxelPoint(side * faces - 0.5) - middle;
        const double aside = marginShare * std::max(std::abs(glm::dot(mm, pose.up)),
                                                    std::abs(glm::dot(mm, right)) / aspect);
        halfHeight = std::max(halfHeight, aside);
        const double depth = glm::dot(mm, pose.forward);
        distance =
            std::max(distance, lens == Lens::orthographic ? 1.0 - depth : aside / slope - depth);
    }
    Camera camera{middle - distance * pose.forward, pose.forward, pose.up, fovDegrees, lens};
    camera.heightMm = 2.0 * halfHeight;
    return camera;
}

glm::dvec3 uprightFor(glm::dvec3 forward) {
    const glm::dvec3 head(0.0, 0.0, 1.0);
    const double across = glm::length(glm::cross(forward, head));
    return across > 0.02 * glm::length(forward) ? head : glm::dvec3(0.0, -1.0, 0.0);
}

}  // namespace haustra::cli
