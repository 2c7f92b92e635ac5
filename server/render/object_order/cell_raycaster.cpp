#include "render/object_order/cell_raycaster.h"

#include "render/gl/picture_readback.h"
#include "render/scene/ray_setup.h"
#include "shaders/uniforms.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

namespace haustra::render {

namespace {

double msSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

}  // namespace

Result<CellRaycaster> CellRaycaster::create(gpu::Context& context, const Grid& grid,
                                            std::shared_ptr<const CellSource> source,
                                            const ObjectOrderOptions& options, glm::ivec3 leaves,
                                            int leafSide) {
    auto projector = TRY(CellProjector::create(options.batchCells));
    auto block = TRY(gpu::UniformBuffer::create(sizeof(shaders::MarchUniforms)));
    CellRaycaster made(context, grid, std::move(source), options, leaves, leafSide,
                       std::move(projector), std::move(block));
    // A budget without room is found here, not at the first picture.
    TRY(made.makePool(1));
    return made;
}

CellRaycaster::CellRaycaster(gpu::Context& context, const Grid& grid,
                             std::shared_ptr<const CellSource> source,
                             const ObjectOrderOptions& options, glm::ivec3 leaves, int leafSide,
                             CellProjector projector, gpu::UniformBuffer marchBlock)
    : context_(&context),
      grid_(grid),
      cells_{grid.size, options.cellSide},
      source_(std::move(source)),
      options_(options),
      leaves_(leaves),
      leafSide_(leafSide),
      projector_(std::move(projector)),
      marchBlock_(std::move(marchBlock)) {}

Result<void> CellRaycaster::makePool(int border) {
    // Readers' functions differ: what has room for the widest border serves them all, and no pixel
    // depends on what else is in a slot.
    if (pool_ && pool_->border() >= border) return {};
    pool_.reset();
    auto made =
        TRY(CellPool::create(source_, cells_, border, options_.budgetBytes, options_.threads));
    pool_ = std::move(made);
    return {};
}

Result<void> CellRaycaster::makeTargets(const CameraView& view, glm::ivec2 size) {
    using gpu::Filter, gpu::Texture, gpu::TexelFormat;
    if (!picture_ || glm::ivec2(picture_->size()) != size) {
        auto made =
            TRY(Texture::create(2, {size, 1}, TexelFormat::rgba8, Filter::nearest, "picture"));
        picture_ = std::move(made);
    }
    if (!view.backdrop || view.backdrop == backdrop_) return {};
    auto made = TRY(Texture::create(2, {view.backdrop->size, 1}, TexelFormat::rgba32f,
                                    Filter::nearest, "backdrop"));
    backdropTexture_ = std::move(made);
    backdropTexture_->upload(view.backdrop->pixels.data());
    backdrop_ = view.backdrop;
    return {};
}

/// The eye among the cells, as the GPU is to see it: the source cell must be the same there.
glm::vec4 CellRaycaster::eyeInCells(const CameraView& view) const {
    const glm::dvec3 eye = grid_.voxelFromPatientPoint(view.camera.positionMm);
    return glm::vec4(eye / double(cells_.side), view.camera.lens == Lens::orthographic ? 0.0 : 1.0);
}

void CellRaycaster::bind(const CameraView& view, const Band& band, const ShownCells& shown) {
    shaders::MarchUniforms u =
        marchUniforms(view, grid_, shown.classified.table(), leaves_, band.pictureSize);
    const double side = leafSide_;
    u.blocksPerUnit = glm::dvec3(cells_.voxels) / side;
    u.firstBlock = float(-0.5 / side);
    u.firstRow = band.firstRow;
    marchBlock_.write(u);
    marchBlock_.bind(shaders::uniformBinding);
    shown.classified.bind();
    if (view.backdrop) backdropTexture_->bind(shaders::backdropUnit);
}

Result<void> CellRaycaster::render(const CameraView& view, const Band& band,
                                   const ShownCells& shown, int border,
                                   const gpu::ComputeProgram& cast,
                                   const gpu::ComputeProgram& resolve, Image& image) {
    const int errorsBefore = context_->errorCount();
    const auto start = std::chrono::steady_clock::now();
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    TRY(makeTargets(view, size));
    TRY(makePool(border));
    const std::vector<PlannedCell> planned = planFrame(cells_, shown.needed, grid_, view.camera,
                                                       band.pictureSize, band.firstRow, band.rows);
    stats_ = {};
    stats_.cells = cells_.cells();
    stats_.nonEmpty = shown.count;
    stats_.inView = int(planned.size());
    const double planMs = msSince(start);

    TRY(projector_.begin(size, cells_, eyeInCells(view)));
    bind(view, band, shown);
    projector_.project(planned, cells_, *pool_, cast, stats_);
    const double castMs = msSince(start) - planMs;

    projector_.rays().bindImage(shaders::rayImage);
    picture_->bindImage(shaders::pictureImage);
    resolve.dispatch(size);
    auto read = readBack(*context_, *picture_, errorsBefore, band.firstRow, image);
    times_ = {{"plan", planMs},
              {"cells", castMs},
              {"picture", msSince(start) - planMs - castMs},
              {"waiting for cells", stats_.waitedMs}};
    return read;
}

std::size_t CellRaycaster::gpuBytes() const {
    std::size_t bytes = projector_.gpuBytes() + (pool_ ? pool_->gpuBytes() : 0);
    for (const auto* texture : {&picture_, &backdropTexture_})
        if (*texture) bytes += (*texture)->bytes();
    return bytes;
}

}  // namespace haustra::render
