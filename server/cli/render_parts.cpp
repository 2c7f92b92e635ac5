#include "cli/render_parts.h"

#include "cli/render_camera.h"
#include "render/optics/optics_presets.h"

#include <string>

namespace haustra::cli {

Result<Optics> opticsOf(const RenderArguments& arguments, const char* otherwise) {
    const std::string name = arguments.optics.empty() ? otherwise : arguments.optics;
    if (std::filesystem::path(name).extension() != ".json") return render::opticsPreset(name);
    auto preset = TRY(readPresetFile(name));
    return std::move(preset.optics);
}

render::MarchOptions marchOf(const RenderArguments& arguments, render::MarchOptions march) {
    march.stepVoxels = arguments.stepVoxels.value_or(march.stepVoxels);
    return march;
}

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

}  // namespace haustra::cli
