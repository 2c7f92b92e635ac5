#include "render/object_order/object_order_raycaster.h"

#include "core/voxel_sweep.h"
#include "render/gl/march_variant.h"
#include "render/object_order/cell_projector.h"
#include "render/object_order/cell_raycaster.h"
#include "render/object_order/cell_source.h"
#include "render/optics/classification.h"
#include "render/scene/lru_cache.h"
#include "render/scene/min_max_octree.h"
#include "render/scene/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace haustra::render {

namespace {

constexpr std::size_t shownCellsKept = 4;

/// Voxels beyond the cell's own that a sample in it may read, but for interpolation: up to the
/// sample before, where that enters too; one more for gradients, which are read on the way; and one
/// for samples on a face, which rounding may put past it.
int borderOf(const Optics& optics, const MarchOptions& march) {
    const MarchVariant variant = MarchVariant::of(optics, false, false);
    const bool looksBack = optics.composition == Composition::firstHit || variant.preIntegrated;
    const int before = looksBack ? int(std::ceil(march.stepVoxels)) : 0;
    return before + (variant.shading || variant.gradientRows ? 1 : 0) + 1;
}

/// Cells with something visible in them, or (where samples show together with the one before
/// them) within `reach` leaves, a step or more.
std::vector<std::uint8_t> neededCells(const ClassifiedOctree& octree, const CellGrid& cells,
                                      int leafSide, int reach) {
    std::vector<std::uint8_t> needed(std::size_t(cells.cells()), 0);
    const glm::ivec3 leaves = octree.nodes(0), last = cells.count() - 1;
    const int leavesInCell = cells.side / leafSide;
    visitBox(glm::ivec3(0), leaves - 1, [&](glm::ivec3 leaf) {
        if (octree.at(0, leaf) == NodeClass::empty) return;
        const glm::ivec3 low = glm::max(leaf - reach, 0) / leavesInCell;
        const glm::ivec3 high = glm::min((leaf + reach) / leavesInCell, last);
        visitBox(low, high, [&](glm::ivec3 cell) { needed[std::size_t(cells.index(cell))] = 1; });
    });
    return needed;
}

}  // namespace

struct ObjectOrderRaycaster::Impl {
    std::shared_ptr<const Scene> scene;
    int threads;
    MinMaxOctree octree;
    CellRaycaster cells;
    LruCache<ShownCells> shown{shownCellsKept};
    MarchPrograms cast{"cell_rays.comp", {"cell_uniforms.h", "cells.glsl"}};
    MarchPrograms resolve{"cell_picture.comp"};

    Result<const ShownCells*> classify(const Optics& optics, const MarchOptions& march) {
        const double step = stepMm(march, scene->grid());
        const bool leaping = march.emptySpaceLeaping;
        if (const ShownCells* known = shown.find(
                [&](const ShownCells& one) { return one.classified.isFor(optics, step, leaping); }))
            return known;
        shown.makeRoom();
        auto made = TRY(Classification::create(optics, step, leaping, octree.level(0), threads));
        ShownCells fresh{std::move(made), {}};
        if (leaping) {
            const ClassifiedOctree classes(octree, fresh.classified.table(), threads);
            const bool segments = MarchVariant::of(optics, false, false).preIntegrated;
            const int reach = segments ? int(std::ceil(march.stepVoxels / octree.leafSide())) : 0;
            fresh.needed = neededCells(classes, cells.cells(), octree.leafSide(), reach);
        } else {
            fresh.needed.assign(std::size_t(cells.cells().cells()), 1);
        }
        fresh.count = int(std::count(fresh.needed.begin(), fresh.needed.end(), 1));
        return shown.keep(std::move(fresh));
    }

    Result<void> render(const CameraView& view, const Band& band, Image& image) {
        const auto seen = TRY(classify(view.optics, view.march));
        const auto variant = MarchVariant::of(view.optics, false, view.backdrop != nullptr);
        const auto casting = TRY(cast.program(variant));
        const auto resolving = TRY(resolve.program(variant));
        return cells.render(view, band, *seen, borderOf(view.optics, view.march), *casting,
                            *resolving, image);
    }
};

Result<void> checkObjectOrder(const ObjectOrderOptions& options) {
    if (std::find(std::begin(cellSides), std::end(cellSides), options.cellSide) ==
        std::end(cellSides))
        return fail(
            ErrorKind::badInput,
            "cells are of 16, 32, 64 or 128 voxels a side, not " + std::to_string(options.cellSide),
            "object-order raycaster");
    if (options.leafSide < 0 || options.leafSide > options.cellSide ||
        (options.leafSide > 0 && options.cellSide % options.leafSide != 0))
        return fail(ErrorKind::badInput, "cells do not consist of whole leaves",
                    "object-order raycaster");
    if (options.batchCells < 1 || options.batchCells > mostBatchCells)
        return fail(ErrorKind::badInput, "a batch is not of 1 to 4096 cells",
                    "object-order raycaster");
    return {};
}

int leafSideOf(const ObjectOrderOptions& options, glm::ivec3 voxels) {
    if (options.leafSide) return options.leafSide;
    const double count = double(voxels.x) * voxels.y * voxels.z;
    return count <= double(1 << 28) ? 2 : count <= double(1u << 31) ? 4 : 8;
}

Result<std::unique_ptr<ObjectOrderRaycaster>> ObjectOrderRaycaster::create(
    gpu::Context& context, std::shared_ptr<const Scene> scene, ObjectOrderOptions options) {
    TRY(checkObjectOrder(options));
    const Grid& grid = scene->grid();
    const int leafSide = leafSideOf(options, grid.size);
    auto octree = MinMaxOctree::fromLeaves(blockRanges(scene->volume, leafSide, options.threads),
                                           leafSide, scene->volume.grid().size);
    auto cells =
        TRY(CellRaycaster::create(context, grid, std::make_shared<ScanCells>(scene->volume.share()),
                                  options, octree.level(0).size, leafSide));
    std::unique_ptr<ObjectOrderRaycaster> made(new ObjectOrderRaycaster(std::unique_ptr<Impl>(
        new Impl{std::move(scene), options.threads, std::move(octree), std::move(cells)})));
    // A driver that refuses the text is found here.
    TRY(made->impl_->cast.program({}));
    return made;
}

ObjectOrderRaycaster::ObjectOrderRaycaster(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ObjectOrderRaycaster::~ObjectOrderRaycaster() = default;

Result<void> ObjectOrderRaycaster::render(const CameraView& view, const Band& band,
                                          Image& picture) {
    TRY(checkBand(band, picture));
    TRY(checkCameraView(view, band.pictureSize));
    return impl_->render(view, band, picture);
}

std::size_t ObjectOrderRaycaster::gpuBytes() const {
    std::size_t bytes = impl_->cells.gpuBytes();
    for (const ShownCells& one : impl_->shown.all())
        bytes += one.classified.gpuBytes();
    return bytes;
}

std::vector<PassTime> ObjectOrderRaycaster::passTimes() const {
    return impl_->cells.passTimes();
}

const ResidencyStats& ObjectOrderRaycaster::residency() const {
    return impl_->cells.residency();
}

}  // namespace haustra::render
