#include "render/object_order/labelled_raycaster.h"

#include "render/gl/march_variant.h"
#include "render/object_order/cell_raycaster.h"
#include "render/object_order/cell_source.h"
#include "render/scene/lru_cache.h"
#include "render/scene/min_max_octree.h"
#include "render/scene/ray_setup.h"
#include "shaders/shader_source.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

namespace haustra::render {

namespace {

/// What the leap map is made with: every opacity above zero shows.
Optics opacityRamp(Optics optics) {
    optics.transferFunction = {{{0.0, glm::dvec3(1.0), 0.0}, {255.0, glm::dvec3(1.0), 1.0}}, {}};
    optics.composition = Composition::emissionAbsorption;
    optics.preIntegrated = false;
    return optics;
}

}  // namespace

/// Colours, with the opacity of voxels that are not shown taken away.
class LabelledRaycaster::ColorCells final : public CellSource {
public:
    explicit ColorCells(std::shared_ptr<const LabelledColorVolume> volume)
        : volume_(std::move(volume)) {}

    /// While nobody reads.
    void show(std::vector<std::int16_t> labels) { labels_ = std::move(labels); }
    bool isShown(std::int16_t label) const {
        return labels_.empty() || std::binary_search(labels_.begin(), labels_.end(), label);
    }
    std::uint8_t opacityAt(std::size_t voxel) const {
        return isShown(volume_->labelAt(voxel)) ? volume_->color[voxel].a : std::uint8_t(0);
    }

    gpu::TexelFormat format() const override { return gpu::TexelFormat::rgba8; }
    std::size_t texelBytes() const override { return sizeof(Rgba); }
    void read(const VoxelBox& box, std::byte* texels) const override {
        auto* out = reinterpret_cast<Rgba*>(texels);
        const Grid& grid = volume_->grid();
        const glm::ivec2 inside = insideOfRow(box, grid.size);
        forEachRow(box, grid.size, [&](int y, int z, std::size_t texel) {
            const std::size_t from = grid.index(box.corner.x + inside.x, y, z);
            Rgba* row = out + texel;
            for (int x = inside.x; x < inside.y; ++x) {
                const std::size_t voxel = from + std::size_t(x - inside.x);
                row[x] = volume_->color[voxel];
                row[x].a = opacityAt(voxel);
            }
            std::fill(row, row + inside.x, row[inside.x]);
            std::fill(row + inside.y, row + box.side, row[inside.y - 1]);
        });
    }

private:
    std::shared_ptr<const LabelledColorVolume> volume_;
    std::vector<std::int16_t> labels_;  // sorted; empty: all
};

struct LabelledRaycaster::Impl {
    std::shared_ptr<const LabelledColorVolume> volume;
    std::shared_ptr<ColorCells> source;
    ObjectOrderOptions options;
    CellRaycaster cells;
    std::vector<std::vector<std::int16_t>> labelsOfCell;
    std::optional<MinMaxOctree> octree = std::nullopt;  // of the opacities that show
    LruCache<ShownCells> shown{1};
    std::vector<std::pair<MarchVariant, gpu::ComputeProgram>> casts = {};
    MarchPrograms cast{
        "cell_rays.comp", {"cell_uniforms.h", "cells.glsl"}, {}, "#define COLOR_CELLS 1\n"};
    MarchPrograms resolve{"cell_picture.comp"};

    Result<void> choose(std::vector<std::int16_t> labels) {
        std::sort(labels.begin(), labels.end());
        for (const std::int16_t label : labels)
            if (std::none_of(labelsOfCell.begin(), labelsOfCell.end(), [&](const auto& list) {
                    return std::binary_search(list.begin(), list.end(), label);
                }))
                return fail(ErrorKind::noResult, "no voxel has the label " + std::to_string(label),
                            "colour volume");
        // Nothing is read before the next picture.
        cells.forget();
        shown.clear();
        source->show(std::move(labels));
        const Grid& grid = volume->grid();
        const auto row = [&](int y, int z, std::span<std::int16_t> values) {
            const std::size_t from = grid.index(0, y, z);
            for (std::size_t x = 0; x < values.size(); ++x)
                values[x] = source->opacityAt(from + x);
        };
        const int leafSide = leafSideOf(options, grid.size);
        octree = MinMaxOctree::fromLeaves(blockRanges(grid.size, row, leafSide, options.threads),
                                          leafSide, grid.size);
        return {};
    }

    Result<const ShownCells*> classify(const Optics& optics, const MarchOptions& march) {
        const double step = stepMm(march, volume->grid());
        const bool leaping = march.emptySpaceLeaping;
        if (const ShownCells* known = shown.find(
                [&](const ShownCells& one) { return one.classified.isFor(optics, step, leaping); }))
            return known;
        auto made =
            TRY(Classification::create(optics, step, leaping, octree->level(0), options.threads));
        shown.makeRoom();
        ShownCells fresh{std::move(made), std::vector<std::uint8_t>(labelsOfCell.size(), 0)};
        int level = 0;
        while (octree->sideAt(level) < options.cellSide)
            ++level;
        const BlockRanges& ofCells = octree->level(std::min(level, octree->levels() - 1));
        for (std::size_t i = 0; i < labelsOfCell.size(); ++i) {
            const bool listed =
                std::any_of(labelsOfCell[i].begin(), labelsOfCell[i].end(),
                            [&](std::int16_t label) { return source->isShown(label); });
            fresh.needed[i] = listed && ofCells.highHu[i] > 0;
        }
        fresh.count = int(std::count(fresh.needed.begin(), fresh.needed.end(), 1));
        return shown.keep(std::move(fresh));
    }
};

Result<std::unique_ptr<LabelledRaycaster>> LabelledRaycaster::create(
    gpu::Context& context, std::shared_ptr<const LabelledColorVolume> volume,
    ObjectOrderOptions options) {
    TRY(checkObjectOrder(options));
    auto source = std::make_shared<ColorCells>(volume);
    const Grid& grid = volume->grid();
    const int leafSide = leafSideOf(options, grid.size);
    const glm::ivec3 leaves = glm::max((grid.size - 1 + leafSide - 1) / leafSide, glm::ivec3(1));
    auto cells = TRY(CellRaycaster::create(context, grid, source, options, leaves, leafSide));
    auto labels = labelsOfCells(*volume, options.cellSide, options.threads);
    std::unique_ptr<LabelledRaycaster> made(new LabelledRaycaster(std::unique_ptr<Impl>(new Impl{
        std::move(volume), std::move(source), options, std::move(cells), std::move(labels)})));
    TRY(made->choose({}));
    return made;
}

LabelledRaycaster::LabelledRaycaster(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LabelledRaycaster::~LabelledRaycaster() = default;

Result<void> LabelledRaycaster::choose(std::vector<std::int16_t> labels) {
    return impl_->choose(std::move(labels));
}

Result<void> LabelledRaycaster::render(const CameraView& asked, const Band& band, Image& picture) {
    CameraView view = asked;
    view.optics = opacityRamp(asked.optics);
    TRY(checkBand(band, picture));
    TRY(checkCameraView(view, band.pictureSize));
    const auto seen = TRY(impl_->classify(view.optics, view.march));
    const auto variant = MarchVariant::of(view.optics, false, view.backdrop != nullptr);
    const auto cast = TRY(impl_->cast.program(variant));
    const auto resolve = TRY(impl_->resolve.program(variant));
    constexpr int border = 2;  // of gradients, and of samples that rounding puts past a face
    return impl_->cells.render(view, band, *seen, border, *cast, *resolve, picture);
}

std::size_t LabelledRaycaster::gpuBytes() const {
    std::size_t bytes = impl_->cells.gpuBytes();
    for (const ShownCells& one : impl_->shown.all())
        bytes += one.classified.gpuBytes();
    return bytes;
}

std::vector<PassTime> LabelledRaycaster::passTimes() const {
    return impl_->cells.passTimes();
}

const ResidencyStats& LabelledRaycaster::residency() const {
    return impl_->cells.residency();
}

}  // namespace haustra::render
