#include "render/view.h"

#include "core/flat_map.h"

#include <algorithm>
#include <cmath>

namespace haustra::render {

namespace {

bool finite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

struct Box {
    glm::dvec3 low, high;
};

/// Patient-space bounds of the grid's outer faces (half a voxel outside the centres).
Box boundsMm(const Grid& grid) {
    Box box{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
        const glm::dvec3 mm = grid.patientFromVoxelPoint(side * glm::dvec3(grid.size) - 0.5);
        box.low = glm::min(box.low, mm);
        box.high = glm::max(box.high, mm);
    }
    return box;
}

struct Axes {
    glm::dvec3 right, down;
};

Result<void> checkWindow(const WindowLevel& window) {
    if (window.widthHu >= 1.0 && window.widthHu <= 65536.0 && std::abs(window.centerHu) <= 65536.0)
        return {};
    return fail(ErrorKind::badInput, "the window's centre or width is out of range", "slice");
}

Axes axesOf(View plane) {
    switch (plane) {
        case View::coronal:
            return {{1, 0, 0}, {0, 0, -1}};  // seen from the front
        case View::sagittal:
            return {{0, 1, 0}, {0, 0, -1}};  // seen from the patient's left
        default:
            return {{1, 0, 0}, {0, 1, 0}};  // axial, seen from the feet
    }
}

}  // namespace

Result<void> checkCamera(const Camera& camera) {
    if (!finite(camera.positionMm) || !finite(camera.forward) || !finite(camera.up))
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

Result<View> viewFromString(const std::string& text) {
    for (const View view : {View::endoscopic, View::axial, View::coronal, View::sagittal,
                            View::flattened, View::flattenedZoom, View::oblique, View::overview})
        if (text == toString(view)) return view;
    return fail(ErrorKind::badInput,
                "no view named '" + text +
                    "' (endoscopic, axial, coronal, sagittal, flattened, flattened-zoom, "
                    "oblique, overview)");
}

const char* toString(View view) {
    switch (view) {
        case View::endoscopic:
            return "endoscopic";
        case View::axial:
            return "axial";
        case View::coronal:
            return "coronal";
        case View::sagittal:
            return "sagittal";
        case View::flattened:
            return "flattened";
        case View::flattenedZoom:
            return "flattened-zoom";
        case View::oblique:
            return "oblique";
        case View::overview:
            return "overview";
    }
    return "";
}

Result<SlicePlacement> placeSlice(const SliceView& view, const Grid& grid, int width, int height) {
    if (view.plane != View::axial && view.plane != View::coronal && view.plane != View::sagittal)
        return fail(ErrorKind::badInput,
                    std::string("the view ") + toString(view.plane) + " is no slice", "slice");
    if (!finite(view.positionMm))
        return fail(ErrorKind::badInput, "the position is not finite", "slice");
    if (!(view.zoom >= 1.0 && view.zoom <= 64.0))
        return fail(ErrorKind::badInput, "the zoom is not within 1 to 64", "slice");
    TRY(checkWindow(view.window));
    if (width <= 0 || height <= 0)
        return fail(ErrorKind::badInput, "the picture has no pixels", "slice");

    const Box box = boundsMm(grid);
    const auto [right, down] = axesOf(view.plane);
    const glm::dvec3 middle = 0.5 * (box.low + box.high);
    const glm::dvec3 extent = box.high - box.low;
    const double wide = std::abs(glm::dot(extent, right)), high = std::abs(glm::dot(extent, down));
    const double pixelMm = std::max(wide / width, high / height) / view.zoom;
    const glm::dvec3 normal = glm::cross(right, down);
    // The picture's centre moves towards the position as the zoom grows.
    glm::dvec3 center = view.positionMm + (middle - view.positionMm) / view.zoom;
    center += normal * glm::dot(view.positionMm - center, normal);
    return SlicePlacement{
        center - pixelMm * (0.5 * (width - 1) * right + 0.5 * (height - 1) * down), pixelMm * right,
        pixelMm * down};
}

Result<SlicePlacement> placeSlice(const ObliqueView& view, int width, int height) {
    Camera plane{view.positionMm, view.forward, view.up};
    plane.lens = Lens::orthographic;
    TRY(checkCamera(plane));
    if (!(view.heightMm >= minObliqueMm && view.heightMm <= maxObliqueMm))
        return fail(ErrorKind::badInput, "the slice's height is not within 1 to 2000 mm", "slice");
    TRY(checkWindow(view.window));
    if (width <= 0 || height <= 0)
        return fail(ErrorKind::badInput, "the picture has no pixels", "slice");

    const double pixelMm = view.heightMm / height;
    const glm::dvec3 forward = glm::normalize(view.forward);
    const glm::dvec3 right = pixelMm * glm::normalize(glm::cross(forward, view.up));
    const glm::dvec3 down = glm::cross(forward, right);
    return SlicePlacement{view.positionMm - 0.5 * (width - 1) * right - 0.5 * (height - 1) * down,
                          right, down};
}

Result<void> checkOverview(const OverviewView& view) {
    TRY(checkCamera(view.camera));
    if (view.camera.lens == Lens::fisheye)
        return fail(ErrorKind::badInput, "an overview is not seen through a fisheye lens",
                    "overview");
    if (view.reader) TRY(checkCamera(*view.reader));
    if (view.bookmarksMm.size() > maxOverviewBookmarks)
        return fail(ErrorKind::badInput,
                    "more than " + std::to_string(maxOverviewBookmarks) + " bookmarks", "overview");
    if (!std::all_of(view.bookmarksMm.begin(), view.bookmarksMm.end(), finite))
        return fail(ErrorKind::badInput, "a bookmark's coordinate is not a finite number",
                    "overview");
    return {};
}

double windowed(double hu, const WindowLevel& window) {
    return 255.0 * std::clamp((hu - window.centerHu) / window.widthHu + 0.5, 0.0, 1.0);
}

}  // namespace haustra::render
