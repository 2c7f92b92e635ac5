#include "cli/render_camera.h"

#include "core/orbit.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace haustra::cli {
namespace {

constexpr double marginShare = 1.04;

/// From where a camera looks: as core/orbit.h has it.
struct Direction {
    double azimuthDegrees = 0.0, elevationDegrees = 0.0;
};

/// Looks at the grid's middle with all of the grid, from face to face, in a picture that is
/// `aspect` times as wide as high, as near as that allows. Of a perspective or fisheye lens the
/// field of view is `fovDegrees`; an orthographic picture is as high as need be.
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

}  // namespace

double fovOf(const RenderArguments& arguments, double ofPerspective) {
    return arguments.fovDegrees.value_or(arguments.lens == Lens::fisheye ? 180.0 : ofPerspective);
}

double aspectOf(const RenderArguments& arguments) {
    return double(arguments.size.x) / arguments.size.y;
}

Camera freeCamera(const RenderArguments& arguments, const Grid& grid) {
    const auto& [eye, look, up] = std::tie(arguments.eyeMm, arguments.lookMm, arguments.up);
    Camera camera = cameraOutside(
        grid, {arguments.azimuthDegrees, arguments.elevationDegrees}, arguments.lens,
        fovOf(arguments, eye.empty() ? 30.0 : Camera{}.fovDegrees), aspectOf(arguments));
    if (!eye.empty()) {
        const glm::dvec3 target = look.empty()
                                      ? grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size - 1))
                                      : look.front();
        camera.positionMm = eye.front();
        camera.forward = target - eye.front();
        camera.up = uprightFor(camera.forward);
    }
    if (!up.empty()) camera.up = up.front();
    if (arguments.heightMm) camera.heightMm = *arguments.heightMm;
    return camera;
}

glm::dvec3 uprightFor(glm::dvec3 forward) {
    const glm::dvec3 head(0.0, 0.0, 1.0);
    const double across = glm::length(glm::cross(forward, head));
    return across > 0.02 * glm::length(forward) ? head : glm::dvec3(0.0, -1.0, 0.0);
}

}  // namespace haustra::cli
