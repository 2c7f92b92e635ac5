#include "render/hybrid/camera_rays.h"

#include "render/scene/ray_setup.h"

namespace haustra::render {

CameraRays::CameraRays(const CameraView& view, const Grid& grid, glm::ivec2 pictureSize)
    : frame_(lensFrame(view.camera, double(pictureSize.x) / pictureSize.y)),
      eye_(grid.voxelFromPatientPoint(view.camera.positionMm)),
      voxelFromMm_(grid.voxelFromPatient()),
      size_(pictureSize),
      stepMm_(stepMm(view.march, grid)) {}

std::optional<VoxelRay> CameraRays::through(glm::dvec2 place) const {
    const auto ray = lensRay(frame_, 2.0 * place / size_ - 1.0);
    if (!ray) return std::nullopt;
    return VoxelRay{eye_ + voxelFromMm_ * ray->fromEye, voxelFromMm_ * ray->direction * stepMm_};
}

}  // namespace haustra::render
