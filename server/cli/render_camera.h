// The cameras that `haustra render` is told.
#pragma once

#include "cli/render_arguments.h"
#include "core/camera.h"
#include "core/grid.h"

namespace haustra::cli {

/// --fov, else the lens's own.
double fovOf(const RenderArguments& arguments, double ofPerspective);
/// The picture's width over its height.
double aspectOf(const RenderArguments& arguments);

/// The camera of --view camera: placed by --eye, or outside.
Camera freeCamera(const RenderArguments& arguments, const Grid& grid);

/// The head's direction, or the front's where a camera looks along the patient.
glm::dvec3 uprightFor(glm::dvec3 forward);

}  // namespace haustra::cli
