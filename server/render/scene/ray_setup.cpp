#include "render/scene/ray_setup.h"

#include "render/optics/leap_map.h"
#include "render/scene/stored_value.h"

#include <algorithm>
#include <cmath>

namespace haustra::render {

double stepMm(const MarchOptions& march, const Grid& grid) {
    const glm::dvec3 spacing = grid.spacingMm();
    return march.stepVoxels * std::min(spacing.x, std::min(spacing.y, spacing.z));
}

shaders::MarchUniforms marchUniforms(const Optics& optics, const MarchOptions& march,
                                     const Grid& grid, const TransferTable& table,
                                     glm::ivec3 blocks, glm::ivec2 size) {
    const glm::dvec3 voxels(grid.size);
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const double step = stepMm(march, grid);
    const auto row = [&](int r) {
        return glm::vec4(voxelFromPatient[0][r], voxelFromPatient[1][r], voxelFromPatient[2][r],
                         0.0) /
               float(grid.size[r]);
    };
    const double perHu = (TransferTable::entries - 1) / (table.lastHu - table.firstHu);
    const auto limit = [](double hu) {
        return std::isinf(hu) ? std::copysign(2.0, hu) : storedFraction(hu);
    };
    const double diagonalMm = glm::distance(grid.patientFromVoxelPoint(glm::dvec3(-0.5)),
                                            grid.patientFromVoxelPoint(voxels - 0.5));

    shaders::MarchUniforms u{};
    u.textureRowX = row(0);
    u.textureRowY = row(1);
    u.textureRowZ = row(2);
    u.voxelTexture = glm::vec4(1.0 / voxels, 0.0);
    u.blocksPerUnit = glm::vec4(voxels / double(blockSide), -0.5 / blockSide);
    u.visibleRange =
        glm::vec4(limit(table.visibleAboveHu), limit(table.visibleBelowHu),
                  storedRange * perHu / TransferTable::entries,
                  ((-storedOffset - table.firstHu) * perHu + 0.5) / TransferTable::entries);
    u.stepping = glm::vec4(step, terminationOpacity, std::ceil(diagonalMm / step) + 1.0,
                           optics.light.halfDepthMm);
    u.light = glm::vec4(optics.light.ambient, optics.light.diffuse, optics.light.specular,
                        optics.light.shininess);
    u.pictureSize = glm::ivec4(size, 0, 0);
    u.lastBlock = glm::ivec4(blocks - 1, coneTile);
    // A normal as long as the slope over two voxels, in stored fractions a millimetre.
    const double rowsPerSlope =
        table.rows > 1 ? 0.5 * storedRange * (table.rows - 1) / table.lastRowHuPerMm : 0.0;
    u.slopes = glm::vec4(rowsPerSlope / table.rows, 0.5 / table.rows,
                         limit(std::min(table.lastHu, 32767.0)), firstHitOpacity);
    u.integralBelow = table.integralBelow;
    u.integralAbove = table.integralAbove;
    return u;
}

shaders::MarchUniforms marchUniforms(const CameraView& view, const Grid& grid,
                                     const TransferTable& table, glm::ivec3 blocks,
                                     glm::ivec2 size) {
    shaders::MarchUniforms u = marchUniforms(view.optics, view.march, grid, table, blocks, size);
    const glm::dvec3 forward = glm::normalize(view.camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const double aspect = double(size.x) / size.y, fov = glm::radians(view.camera.fovDegrees);
    const double halfHeight = view.camera.lens == Lens::perspective ? std::tan(0.5 * fov)
                              : view.camera.lens == Lens::fisheye   ? 0.5 * fov
                                                                    : 0.5 * view.camera.heightMm;
    const glm::dvec3 voxels(grid.size);
    u.eyeTexture =
        glm::vec4((grid.voxelFromPatientPoint(view.camera.positionMm) + 0.5) / voxels, 0.0);
    u.forwardMm = glm::vec4(forward, 0.0);
    u.rightMm = glm::vec4(right * halfHeight * aspect, 0.0);
    u.downMm = glm::vec4(-up * halfHeight, 0.0);
    u.pictureSize.z = int(view.camera.lens);
    // No ray inside the volume is longer than the way from the camera to the farthest corner.
    double farthestMm = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
        farthestMm = std::max(
            farthestMm,
            glm::distance(view.camera.positionMm, grid.patientFromVoxelPoint(side * voxels - 0.5)));
    }
    u.stepping.z = float(std::ceil(farthestMm / double(stepMm(view.march, grid))) + 1.0);
    return u;
}

}  // namespace haustra::render
