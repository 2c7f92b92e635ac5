#include "render/native/native_scene.h"

#include "render/scene/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::render {

namespace {

// Each holds a leap map, a byte for eight voxels.
constexpr std::size_t classificationsKept = 4;

std::vector<std::int16_t> doubledRows(const Volume<std::int16_t>& volume) {
    std::vector<std::int16_t> twice;
    if (volume.grid().size.x > 1) return twice;
    for (const std::int16_t hu : volume.voxels())
        twice.insert(twice.end(), 2, hu);
    return twice;
}

}  // namespace

PacketVolume::PacketVolume(Volume<std::int16_t> volume)
    : volume_(std::move(volume)), twice_(doubledRows(volume_)) {}

void PacketVolume::describe(PacketScene& scene) const {
    const glm::ivec3 size = volume_.grid().size;
    for (int axis = 0; axis < 3; ++axis)
        scene.size[axis] = size[axis];
    scene.voxels = twice_.empty() ? volume_.voxels().data() : twice_.data();
    scene.rowStride = twice_.empty() ? size.x : 2;
    scene.sliceStride = scene.rowStride * size.y;
}

NativeScene::NativeScene(std::shared_ptr<const Scene> scene, int threads)
    : scene_(std::move(scene)),
      volume_(scene_->volume.share()),
      pool_(threads),
      recent_(classificationsKept) {}

Result<const NativeScene::Classified*> NativeScene::classification(const Optics& optics,
                                                                   const MarchOptions& march) {
    TRY(checkOptics(optics));
    TRY(checkMarch(march, optics));
    const double step = stepMm(march, scene_->grid());
    const bool leaping = march.emptySpaceLeaping;
    if (const Classified* known = recent_.find([&](const Classified& one) {
            return one.stepMm == step && one.leaping == leaping && one.optics == optics;
        }))
        return known;
    recent_.makeRoom();
    const BlockRanges& ranges = scene_->ranges;
    Classified made{optics, step, leaping, makeTransferTable(optics, step), {}};
    if (leaping)
        made.leap = leapDistances(ranges, made.table, pool_.threads());
    else
        made.leap.assign(ranges.lowHu.size(), 0);
    made.leap.insert(made.leap.end(), 3, 0);
    return recent_.keep(std::move(made));
}

PacketScene NativeScene::packetScene(const shaders::MarchUniforms& uniforms,
                                     const Classified& classified) const {
    const Grid& grid = scene_->grid();
    PacketScene packet;
    volume_.describe(packet);
    const glm::ivec3 lastBlock = scene_->ranges.size - 1;
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    for (int axis = 0; axis < 3; ++axis) {
        packet.lastBlock[axis] = lastBlock[axis];
        for (int c = 0; c < 3; ++c)
            packet.voxelFromMm[axis][c] = float(voxelFromPatient[c][axis]);
    }
    packet.leap = classified.leap.data();
    const TransferTable& table = classified.table;
    packet.composition = classified.optics.composition;
    packet.shading = classified.optics.shading;
    packet.table = &table.rgba[0].x;
    packet.rows = table.rows;
    if (!table.integrals.empty()) packet.integrals = &table.integrals[0].x;
    packet.entriesPerHu = float(table.entryOf(1.0) - table.entryOf(0.0));
    packet.firstEntry = float(table.entryOf(0.0));
    // A normal is twice as long as the gradient.
    if (table.rows > 1)
        packet.rowsPerGradient = float(0.5 * (table.rows - 1) / table.lastRowHuPerMm);
    packet.lastVisibleHu = float(std::min(table.lastHu, 32767.0));
    packet.visibleAboveHu = float(table.visibleAboveHu);
    packet.visibleBelowHu = float(table.visibleBelowHu);
    packet.u = uniforms;
    return packet;
}

}  // namespace haustra::render
