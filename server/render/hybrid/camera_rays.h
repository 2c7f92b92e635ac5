// A camera's rays on the CPU.
#pragma once

#include "core/grid.h"
#include "render/scene/lens.h"
#include "render/scene/min_max_octree.h"
#include "render/scene/picture.h"

#include <optional>

namespace haustra::render {

/// The rays of shaders/rays.glsl in voxel coordinates; t counts samples from the eye or from an
/// orthographic camera's plane. In double precision: they lie within a hundredth of a voxel of the
/// shaders'. Immutable; any number of threads.
class CameraRays {
public:
    /// The view must have passed its checks.
    CameraRays(const CameraView& view, const Grid& grid, glm::ivec2 pictureSize);

    /// Through a place of the picture (pixels; centres at halves); none where a fisheye's shows
    /// nothing.
    std::optional<VoxelRay> through(glm::dvec2 place) const;
    /// Through a pixel's centre.
    std::optional<VoxelRay> through(glm::ivec2 pixel) const {
        return through(glm::dvec2(pixel) + 0.5);
    }
    /// Whether rays spread from one point, evenly over the picture.
    bool perspective() const { return frame_.lens == Lens::perspective; }

private:
    LensFrame frame_;
    glm::dvec3 eye_;          // voxel coordinates
    glm::dmat3 voxelFromMm_;  // of vectors
    glm::dvec2 size_;
    double stepMm_;
};

}  // namespace haustra::render
