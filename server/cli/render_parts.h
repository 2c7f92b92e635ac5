// What `haustra render` is told, as the renderer takes it.
#pragma once

#include "cli/render_arguments.h"
#include "core/grid.h"
#include "core/optics.h"
#include "core/result.h"
#include "render/scene/picture.h"

namespace haustra::cli {

/// --tf, a preset's name or file; `otherwise` names the view's own. Fails naming the file.
Result<Optics> opticsOf(const RenderArguments& arguments, const char* otherwise);

/// --step, else as it is.
render::MarchOptions marchOf(const RenderArguments& arguments, render::MarchOptions march = {});

/// --fov, else the lens's own.
double fovOf(const RenderArguments& arguments, double ofPerspective);
/// The picture's width over its height.
double aspectOf(const RenderArguments& arguments);

/// The camera of --view camera: placed by --eye, or outside.
Camera freeCamera(const RenderArguments& arguments, const Grid& grid);

}  // namespace haustra::cli
