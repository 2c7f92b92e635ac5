#include "core/slice_placement.h"

#include <algorithm>
#include <cmath>

namespace haustra {
namespace {

struct Axes {
    glm::dvec3 right, down;
};

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

ScanBounds boundsMm(const Grid& grid) {
    ScanBounds bounds{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
        const glm::dvec3 mm = grid.patientFromVoxelPoint(side * glm::dvec3(grid.size) - 0.5);
        bounds.low = glm::min(bounds.low, mm);
        bounds.high = glm::max(bounds.high, mm);
    }
    return bounds;
}

glm::dvec2 SlicePlacement::pixelFromPatient(glm::dvec3 patientMm) const {
    const glm::dvec3 offsetMm = patientMm - topLeftMm;
    return glm::dvec2(glm::dot(offsetMm, rightMm), glm::dot(offsetMm, downMm)) /
           glm::dot(rightMm, rightMm);
}

SlabSamples slabSamples(const Slab& slab, glm::dvec3 normal, const Grid& grid) {
    const glm::dvec3 spacing = grid.spacingMm();
    const double stepMm = 0.5 * std::min(spacing.x, std::min(spacing.y, spacing.z));
    SlabSamples samples;
    // The middles of 2·aside + 1 equal layers, none thicker than the step.
    samples.aside = int(std::ceil(0.5 * (slab.thicknessMm / stepMm - 1.0) - 1e-9));
    samples.aside = std::clamp(samples.aside, 0, maxSamplesAside);
    samples.stepMm = slab.thicknessMm / samples.count() * glm::normalize(normal);
    return samples;
}

Result<SlicePlacement> placeSlice(const SliceView& view, const Grid& grid, int width, int height) {
    TRY(checkSlice(view));
    if (width <= 0 || height <= 0)
        return fail(ErrorKind::badInput, "the picture has no pixels", "slice");

    const ScanBounds box = boundsMm(grid);
    const auto [right, down] = axesOf(view.plane);
    const glm::dvec3 middle = 0.5 * (box.low + box.high);
    const glm::dvec3 extent = box.high - box.low;
    const double wide = std::abs(glm::dot(extent, right)), high = std::abs(glm::dot(extent, down));
    const double pixelMm = std::max(wide / width, high / height) / view.zoom;
    const glm::dvec3 normal = glm::cross(right, down);
    // The picture's centre moves towards the position as the zoom grows.
    glm::dvec3 center = view.positionMm + (middle - view.positionMm) / view.zoom;
    center += normal * glm::dot(view.positionMm - center, normal);
    center -= view.panMm.x * right + view.panMm.y * down;
    return SlicePlacement{
        center - pixelMm * (0.5 * (width - 1) * right + 0.5 * (height - 1) * down), pixelMm * right,
        pixelMm * down};
}

Result<SlicePlacement> placeSlice(const ObliqueView& view, int width, int height) {
    TRY(checkOblique(view));
    if (width <= 0 || height <= 0)
        return fail(ErrorKind::badInput, "the picture has no pixels", "slice");

    const double pixelMm = view.heightMm / height;
    const glm::dvec3 forward = glm::normalize(view.forward);
    const glm::dvec3 right = pixelMm * glm::normalize(glm::cross(forward, view.up));
    const glm::dvec3 down = glm::cross(forward, right);
    return SlicePlacement{view.positionMm - 0.5 * (width - 1) * right - 0.5 * (height - 1) * down,
                          right, down};
}

}  // namespace haustra
