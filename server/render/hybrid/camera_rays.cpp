#include "render/hybrid/camera_rays.h"

#include "render/scene/ray_setup.h"

#include <cmath>
#include <numbers>

namespace haustra::render {

CameraRays::CameraRays(const CameraView& view, const Grid& grid, glm::ivec2 pictureSize)
    : lens_(view.camera.lens),
      eye_(grid.voxelFromPatientPoint(view.camera.positionMm)),
      voxelFromMm_(grid.voxelFromPatient()),
      forward_(glm::normalize(view.camera.forward)),
      right_(glm::normalize(glm::cross(forward_, view.camera.up))),
      down_(glm::cross(forward_, right_)),
      size_(pictureSize),
      stepMm_(stepMm(view.march, grid)) {
    const double half = lens_ == Lens::perspective
                            ? std::tan(glm::radians(0.5 * view.camera.fovDegrees))
                        : lens_ == Lens::fisheye ? glm::radians(0.5 * view.camera.fovDegrees)
                                                 : 0.5 * view.camera.heightMm;
    right_ *= half * size_.x / size_.y;
    down_ *= half;
}

std::optional<VoxelRay> CameraRays::through(glm::dvec2 place) const {
    const glm::dvec2 ndc = 2.0 * place / size_ - 1.0;
    const glm::dvec3 aside = ndc.x * right_ + ndc.y * down_;
    glm::dvec3 origin = eye_, direction = forward_;
    if (lens_ == Lens::perspective) {
        direction = glm::normalize(forward_ + aside);
    } else if (lens_ == Lens::fisheye) {
        const double angle = glm::length(aside);
        if (angle > std::numbers::pi) return std::nullopt;
        direction = std::cos(angle) * forward_ + std::sin(angle) / std::max(angle, 1e-9) * aside;
    } else {
        origin += voxelFromMm_ * aside;
    }
    return VoxelRay{origin, voxelFromMm_ * direction * stepMm_};
}

}  // namespace haustra::render
