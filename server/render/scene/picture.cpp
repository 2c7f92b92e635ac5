#include "render/scene/picture.h"

#include "core/flat_map.h"

#include <algorithm>
#include <cmath>

namespace haustra::render {

Result<void> checkMarch(const MarchOptions& march) {
    if (march.stepVoxels >= 0.05 && march.stepVoxels <= 4.0) return {};
    return fail(ErrorKind::badInput, "the sampling distance is not within 0.05 to 4 voxels");
}

Result<void> checkMarch(const MarchOptions& march, const Optics& optics) {
    if (optics.preIntegrated && march.stepVoxels > longestPreIntegratedStep)
        return fail(ErrorKind::badInput,
                    "the sampling distance of a pre-integrated transfer function is over a voxel");
    return checkMarch(march);
}

Result<void> checkCameraView(const CameraView& view, glm::ivec2 pictureSize) {
    TRY(checkCamera(view.camera));
    TRY(checkOptics(view.optics));
    TRY(checkMarch(view.march, view.optics));
    if (view.backdrop &&
        (view.backdrop->size != pictureSize ||
         view.backdrop->pixels.size() != std::size_t(pictureSize.x) * std::size_t(pictureSize.y)))
        return fail(ErrorKind::badInput, "the backdrop is not of the picture's size", "camera");
    return {};
}

Result<void> checkFlatWindow(const FlatWindow& window, int width) {
    if (!std::isfinite(window.center.x) || !(std::abs(window.center.y) <= maxFlatHeight))
        return fail(ErrorKind::badInput, "the window's centre is not on the strip", "flat window");
    if (!(window.pixelsPerUnit <= maxPixelsPerUnit &&
          window.pixelsPerUnit * maxCircumferences >= width))
        return fail(ErrorKind::badInput,
                    "the pixels a circumference are over " + std::to_string(maxPixelsPerUnit) +
                        ", or so few that the picture shows more than " +
                        std::to_string(maxCircumferences) + " circumferences",
                    "flat window");
    return {};
}

double windowed(double hu, const WindowLevel& window) {
    return 255.0 * std::clamp((hu - window.centerHu) / window.widthHu + 0.5, 0.0, 1.0);
}

}  // namespace haustra::render
