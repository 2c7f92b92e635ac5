// Cameras that look at a scan from outside.
#pragma once

#include "core/grid.h"
#include "render/scene/picture.h"

namespace haustra::cli {

/// From where a camera looks: as core/orbit.h has it.
struct Direction {
    double azimuthDegrees = 0.0, elevationDegrees = 0.0;
};

/// Looks at the grid's middle with all of the grid, from face to face, in a picture that is
/// `aspect` times as wide as high, as near as that allows. Of a perspective or fisheye lens the
/// field of view is `fovDegrees`; an orthographic picture is as high as need be.
Camera cameraOutside(const Grid& grid, Direction from, Lens lens, double fovDegrees, double aspect);

/// The head's direction, or the front's where a camera looks along the patient.
glm::dvec3 uprightFor(glm::dvec3 forward);

}  // namespace haustra::cli
