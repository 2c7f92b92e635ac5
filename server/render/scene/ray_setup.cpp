#include "render/scene/ray_setup.h"

#include "render/optics/leap_map.h"
#include "render/scene/lens.h"
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
        return glm::vec3(voxelFromPatient[0][r], voxelFromPatient[1][r], voxelFromPatient[2][r]) /
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
    u.voxelTexture = 1.0 / voxels;
    u.blocksPerUnit = voxels / double(blockSide);
    u.firstBlock = float(-0.5 / blockSide);
    u.visibleAbove = float(limit(table.visibleAboveHu));
    u.visibleBelow = float(limit(table.visibleBelowHu));
    u.lastVisible = float(limit(std::min(table.lastHu, 32767.0)));
    u.entryScale = float(storedRange * perHu / TransferTable::entries);
    u.entryBias = float(((-storedOffset - table.firstHu) * perHu + 0.5) / TransferTable::entries);
    u.stepMm = float(step);
    u.terminationOpacity = float(terminationOpacity);
    u.firstHitOpacity = float(firstHitOpacity);
    u.mostSteps = float(std::ceil(diagonalMm / step) + 1.0);
    u.lightHalvesMm = float(optics.light.halfDepthMm);
    u.ambient = float(optics.light.ambient);
    u.diffuse = float(optics.light.diffuse);
    u.specular = float(optics.light.specular);
    u.shininess = float(optics.light.shininess);
    u.pictureSize = size;
    u.lastBlock = blocks - 1;
    u.coneTileSide = coneTile;
    // A normal is as long as the gradient over two voxels, in stored fractions a millimetre.
    const double rowsPerGradient =
        table.rows > 1 ? 0.5 * storedRange * (table.rows - 1) / table.lastRowHuPerMm : 0.0;
    u.rowScale = float(rowsPerGradient / table.rows);
    u.rowBias = float(0.5 / table.rows);
    u.integralBelow = table.integralBelow;
    u.integralAbove = table.integralAbove;
    return u;
}

shaders::MarchUniforms marchUniforms(const CameraView& view, const Grid& grid,
                                     const TransferTable& table, glm::ivec3 blocks,
                                     glm::ivec2 size) {
    shaders::MarchUniforms u = marchUniforms(view.optics, view.march, grid, table, blocks, size);
    const LensFrame frame = lensFrame(view.camera, double(size.x) / size.y);
    const glm::dvec3 voxels(grid.size);
    u.eyeTexture = (grid.voxelFromPatientPoint(view.camera.positionMm) + 0.5) / voxels;
    u.forwardMm = frame.ahead;
    u.rightMm = frame.right;
    u.downMm = frame.down;
    u.lens = int(frame.lens);
    // No ray inside the volume is longer than the way from the camera to the farthest corner.
    double farthestMm = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
        farthestMm = std::max(
            farthestMm,
            glm::distance(view.camera.positionMm, grid.patientFromVoxelPoint(side * voxels - 0.5)));
    }
    u.mostSteps = float(std::ceil(farthestMm / double(stepMm(view.march, grid))) + 1.0);
    return u;
}

}  // namespace haustra::render
