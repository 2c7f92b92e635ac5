#include "reader/slice_map.h"

#include <algorithm>
#include <cmath>

namespace haustra::reader {
namespace {

struct Axes {
    glm::dvec3 right, down;
};

Axes axesOf(View view) {
    switch (view) {
        case View::coronal:
            return {{1, 0, 0}, {0, 0, -1}};
        case View::sagittal:
            return {{0, 1, 0}, {0, 0, -1}};
        default:
            return {{1, 0, 0}, {0, 1, 0}};
    }
}

}  // namespace

SliceMap::SliceMap(const SliceView& slice, const Grid& grid, int width, int height) {
    const auto [right, down] = axesOf(slice.plane);
    right_ = right;
    down_ = down;
    // The box of the voxels' outer faces in patient space.
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
        const glm::dvec3 mm = grid.patientFromVoxelPoint(side * glm::dvec3(grid.size) - 0.5);
        low = glm::min(low, mm);
        high = glm::max(high, mm);
    }
    const glm::dvec3 middle = 0.5 * (low + high), extent = high - low;
    pixelMm_ = std::max(std::abs(glm::dot(extent, right)) / width,
                        std::abs(glm::dot(extent, down)) / height) /
               slice.zoom;
    glm::dvec3 center = slice.positionMm + (middle - slice.positionMm) / slice.zoom;
    center += normal() * glm::dot(slice.positionMm - center, normal());
    topLeftMm_ = center - pixelMm_ * (0.5 * (width - 1) * right_ + 0.5 * (height - 1) * down_);
}

glm::dvec3 SliceMap::patientFromPixel(glm::dvec2 pixel) const {
    return topLeftMm_ + pixelMm_ * (pixel.x * right_ + pixel.y * down_);
}

glm::dvec2 SliceMap::pixelFromPatient(glm::dvec3 patientMm) const {
    const glm::dvec3 offset = (patientMm - topLeftMm_) / pixelMm_;
    return {glm::dot(offset, right_), glm::dot(offset, down_)};
}

EdgeLetters edgeLetters(View view) {
    switch (view) {
        case View::coronal:
            return {"R", "L", "H", "F"};
        case View::sagittal:
            return {"A", "P", "H", "F"};
        default:
            return {"R", "L", "A", "P"};
    }
}

glm::dvec3 sliceNormal(View view) {
    switch (view) {
        case View::coronal:
            return {0, 1, 0};
        case View::sagittal:
            return {1, 0, 0};
        default:
            return {0, 0, 1};
    }
}

}  // namespace haustra::reader
