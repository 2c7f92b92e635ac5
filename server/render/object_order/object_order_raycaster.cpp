#include "render/object_order/object_order_raycaster.h"

#include "render/classification.h"
#include "render/lately_used.h"
#include "render/march_variant.h"
#include "render/min_max_octree.h"
#include "render/object_order/cell_pool.h"
#include "render/object_order/cell_projector.h"
#include "render/picture_readback.h"
#include "render/ray_setup.h"
#include "shaders/uniforms.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

namespace haustra::render {

namespace {

constexpr std::size_t classificationsKept = 4;

/// Voxels along a leaf of the octree, whose map of distances lets rays leap inside cells: the
/// smaller, the better they leap, and the more memory the map takes.
int leafSideOf(const Grid& grid) {
    const std::size_t voxels = grid.voxelCount();
    return voxels <= std::size_t(1) << 28 ? 2 : voxels <= std::size_t(1) << 31 ? 4 : 8;
}

/// Voxels beyond the cell's own that a sample in it may read, but for interpolation: a voxel for
/// gradients; and up to the sample before, where that enters too.
int borderOf(const Optics& optics, const MarchOptions& march) {
    const int before = int(std::ceil(march.stepVoxels));
    if (optics.composition == Composition::firstHit) return before + (optics.shading ? 1 : 0);
    const bool segments =
        optics.composition == Composition::emissionAbsorption && optics.preIntegrated;
    return segments ? std::max(before, 1) : 1;
}

/// A volume as one transfer function shows it: what rays look up, and the cells that they need.
struct Shown {
    Classification classified;
    std::vector<std::uint8_t> needed;
    int count = 0;
};

/// Cells with something visible in them, or (where samples show together with the one before
/// them) within `reach` leaves, a step or more.
std::vector<std::uint8_t> neededCells(const ClassifiedOctree& octree, const CellGrid& cells,
                                      int leafSide, int reach) {
    std::vector<std::uint8_t> needed(std::size_t(cells.cells()), 0);
    const glm::ivec3 leaves = octree.nodes(0), last = cells.count() - 1;
    const int leavesInCell = cells.side / leafSide;
    glm::ivec3 leaf;
    for (leaf.z = 0; leaf.z < leaves.z; ++leaf.z)
        for (leaf.y = 0; leaf.y < leaves.y; ++leaf.y)
            for (leaf.x = 0; leaf.x < leaves.x; ++leaf.x) {
                if (octree.at(0, leaf) == NodeClass::empty) continue;
                const glm::ivec3 low = glm::max(leaf - reach, 0) / leavesInCell;
                const glm::ivec3 high = glm::min((leaf + reach) / leavesInCell, last);
                for (int z = low.z; z <= high.z; ++z)
                    for (int y = low.y; y <= high.y; ++y)
                        for (int x = low.x; x <= high.x; ++x)
                            needed[std::size_t(cells.index({x, y, z}))] = 1;
            }
    return needed;
}

double msSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

}  // namespace

struct ObjectOrderRaycaster::Impl {
    gpu::Context& context;
    std::shared_ptr<const Scene> scene;
    ObjectOrderOptions options;
    CellGrid cells;
    std::shared_ptr<const CellSource> source;
    MinMaxOctree octree;
    CellProjector projector;
    gpu::UniformBuffer marchBlock;
    LatelyUsed<Shown> shown{classificationsKept};
    MarchPrograms cast{"cell_rays.comp", {"cell_uniforms.h", "cells.glsl"}};
    MarchPrograms resolve{"cell_picture.comp"};
    std::unique_ptr<CellPool> pool = nullptr;
    std::optional<gpu::Texture> picture = std::nullopt, backdrop = std::nullopt;
    std::shared_ptr<const Backdrop> bound = nullptr;  // what `backdrop` holds
    ResidencyStats stats = {};
    std::vector<PassTime> times = {};

    Result<const Shown*> classify(const Optics& optics, const MarchOptions& march) {
        const double step = stepMm(march, scene->grid());
        const bool leaping = march.emptySpaceLeaping;
        if (const Shown* known = shown.find(
                [&](const Shown& one) { return one.classified.isFor(optics, step, leaping); }))
            return known;
        shown.makeRoom();
        auto made = Classification::create(optics, step, leaping, octree.level(0), options.threads);
        if (!made) return tl::make_unexpected(made.error());
        Shown fresh{std::move(*made), {}};
        if (leaping) {
            const ClassifiedOctree classes(octree, fresh.classified.table(), options.threads);
            const bool segments = MarchVariant::of(optics, false, false).preIntegrated;
            const int reach = segments ? int(std::ceil(march.stepVoxels / octree.leafSide())) : 0;
            fresh.needed = neededCells(classes, cells, octree.leafSide(), reach);
        } else {
            fresh.needed.assign(std::size_t(cells.cells()), 1);
        }
        fresh.count = int(std::count(fresh.needed.begin(), fresh.needed.end(), 1));
        return shown.keep(std::move(fresh));
    }

    Result<void> makePool(int border) {
        if (pool && pool->border() == border) return {};
        pool.reset();
        auto made = CellPool::create(source, cells, border, options.budgetBytes, options.threads);
        if (!made) return tl::make_unexpected(made.error());
        pool = std::move(*made);
        return {};
    }

    Result<void> makeTargets(const CameraView& view, glm::ivec2 size) {
        using gpu::Filter, gpu::Texture, gpu::TexelFormat;
        if (!picture || glm::ivec2(picture->size()) != size) {
            auto made =
                Texture::create(2, {size, 1}, TexelFormat::rgba8, Filter::nearest, "picture");
            if (!made) return tl::make_unexpected(made.error());
            picture = std::move(*made);
        }
        if (!view.backdrop || view.backdrop == bound) return {};
        auto made = Texture::create(2, {view.backdrop->size, 1}, TexelFormat::rgba32f,
                                    Filter::nearest, "backdrop");
        if (!made) return tl::make_unexpected(made.error());
        backdrop = std::move(*made);
        backdrop->upload(view.backdrop->pixels.data());
        bound = view.backdrop;
        return {};
    }

    /// The eye among the cells, as the GPU is to see it: the source cell must be the same there.
    glm::vec4 eyeInCells(const CameraView& view) const {
        const glm::dvec3 eye = scene->grid().voxelFromPatientPoint(view.camera.positionMm);
        return glm::vec4(eye / double(cells.side),
                         view.camera.lens == Lens::orthographic ? 0.0 : 1.0);
    }

    Result<void> render(const CameraView& view, const Band& band, Image& image) {
        const int errorsBefore = context.errorCount();
        const auto start = std::chrono::steady_clock::now();
        const glm::ivec2 size(band.pictureSize.x, band.rows);
        if (auto made = makeTargets(view, size); !made) return made;
        if (auto made = makePool(borderOf(view.optics, view.march)); !made) return made;
        const auto seen = classify(view.optics, view.march);
        if (!seen) return tl::make_unexpected(seen.error());
        const auto variant = MarchVariant::of(view.optics, false, view.backdrop != nullptr);
        const auto casting = cast.program(variant);
        if (!casting) return tl::make_unexpected(casting.error());
        const auto resolving = resolve.program(variant);
        if (!resolving) return tl::make_unexpected(resolving.error());

        const std::vector<PlannedCell> planned =
            planFrame(cells, (*seen)->needed, scene->grid(), view.camera, band.pictureSize,
                      band.firstRow, band.rows);
        stats = {};
        stats.cells = cells.cells();
        stats.nonEmpty = (*seen)->count;
        stats.inView = int(planned.size());
        const double planMs = msSince(start);

        if (auto begun = projector.begin(size, cells, eyeInCells(view)); !begun) return begun;
        bind(view, band, **seen);
        projector.project(planned, cells, *pool, **casting, stats);
        const double castMs = msSince(start) - planMs;

        projector.rays().bindImage(shaders::rayImage);
        picture->bindImage(shaders::pictureImage);
        (*resolving)->dispatch(size);
        auto read = readBack(context, *picture, errorsBefore, band.firstRow, image);
        times = {{"plan", planMs},
                 {"cells", castMs},
                 {"picture", msSince(start) - planMs - castMs},
                 {"waiting for cells", stats.waitedMs}};
        return read;
    }

    void bind(const CameraView& view, const Band& band, const Shown& seen) {
        shaders::MarchUniforms u = marchUniforms(view, scene->grid(), seen.classified.table(),
                                                 octree.level(0).size, band.pictureSize);
        const double side = octree.leafSide();
        u.blocksPerUnit = glm::vec4(glm::dvec3(cells.voxels) / side, -0.5 / side);
        u.pictureSize.w = band.firstRow;
        marchBlock.write(u);
        marchBlock.bind(shaders::uniformBinding);
        seen.classified.bind();
        if (view.backdrop) backdrop->bind(shaders::backdropUnit);
    }
};

Result<std::unique_ptr<ObjectOrderRaycaster>> ObjectOrderRaycaster::create(
    gpu::Context& context, std::shared_ptr<const Scene> scene, ObjectOrderOptions options) {
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
    auto projector = CellProjector::create();
    if (!projector) return tl::make_unexpected(projector.error());
    auto block = gpu::UniformBuffer::create(sizeof(shaders::MarchUniforms));
    if (!block) return tl::make_unexpected(block.error());
    const Grid& grid = scene->grid();
    auto source = std::make_shared<ScanCells>(scene->volume.share());
    const int leafSide = options.leafSide ? options.leafSide : leafSideOf(grid);
    auto octree = MinMaxOctree::build(scene->volume, leafSide, options.threads);
    const CellGrid cells{grid.size, options.cellSide};
    std::unique_ptr<ObjectOrderRaycaster> made(new ObjectOrderRaycaster(std::unique_ptr<Impl>(
        new Impl{context, std::move(scene), options, cells, std::move(source), std::move(octree),
                 std::move(*projector), std::move(*block)})));
    // A budget without room, or a driver that refuses the text, is found here.
    if (auto room = made->impl_->makePool(1); !room) return tl::make_unexpected(room.error());
    if (auto cast = made->impl_->cast.program({}); !cast) return tl::make_unexpected(cast.error());
    return made;
}

ObjectOrderRaycaster::ObjectOrderRaycaster(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ObjectOrderRaycaster::~ObjectOrderRaycaster() = default;

Result<void> ObjectOrderRaycaster::render(const CameraView& view, const Band& band,
                                          Image& picture) {
    if (auto sound = checkBand(band, picture); !sound) return sound;
    if (auto sound = checkCameraView(view, band.pictureSize); !sound) return sound;
    return impl_->render(view, band, picture);
}

std::size_t ObjectOrderRaycaster::gpuBytes() const {
    const Impl& my = *impl_;
    std::size_t bytes = my.projector.gpuBytes() + (my.pool ? my.pool->gpuBytes() : 0);
    for (const auto* texture : {&my.picture, &my.backdrop})
        if (*texture) bytes += (*texture)->bytes();
    for (const Shown& one : my.shown.all())
        bytes += one.classified.gpuBytes();
    return bytes;
}

std::vector<PassTime> ObjectOrderRaycaster::passTimes() const {
    return impl_->times;
}

const ResidencyStats& ObjectOrderRaycaster::residency() const {
    return impl_->stats;
}

}  // namespace haustra::render
