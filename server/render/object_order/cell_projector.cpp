#include "render/object_order/cell_projector.h"

#include "shaders/uniforms.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace haustra::render {

namespace {

constexpr int batchesAhead = 4, itemsInBatch = 1 << 18;
constexpr std::size_t cellBytes = mostBatchCells * sizeof(shaders::CellInSlot);
constexpr std::size_t batchBytes = cellBytes + itemsInBatch * sizeof(glm::uvec2);
static_assert(cellBytes % 4096 == 0 && batchBytes % 4096 == 0);
// One tile of the largest picture after another, at least, fits into a batch.
static_assert(itemsInBatch >= (maxPictureSide / rayTile) * (maxPictureSide / rayTile));

}  // namespace

Result<CellProjector> CellProjector::create(int batchCells) {
    auto batches = TRY(gpu::MappedBuffer::create(batchesAhead * batchBytes, "cells to draw"));
    auto block = TRY(gpu::UniformBuffer::create(sizeof(shaders::CellUniforms)));
    return CellProjector(std::move(batches), std::move(block), batchCells);
}

CellProjector::CellProjector(gpu::MappedBuffer batches, gpu::UniformBuffer block, int batchCells)
    : batches_(std::move(batches)),
      block_(std::move(block)),
      ring_(batchesAhead),
      batchCells_(batchCells) {
    for (std::size_t i = 0; i < ring_.size(); ++i)
        ring_[i].offset = i * batchBytes;
}

std::size_t CellProjector::gpuBytes() const {
    return rays_ ? rays_->bytes() : 0;
}

Result<void> CellProjector::begin(glm::ivec2 bandSize, const CellGrid& cells, glm::vec4 eye) {
    if (!rays_ || glm::ivec2(rays_->size()) != bandSize) {
        rays_.reset();
        auto rays = TRY(gpu::Texture::create(2, {bandSize, 1}, gpu::TexelFormat::rgba32f,
                                             gpu::Filter::nearest, "rays"));
        tiles_ = (bandSize + rayTile - 1) / rayTile;
        auto live = TRY(gpu::MappedBuffer::create(
            std::size_t(tiles_.x) * std::size_t(tiles_.y) * sizeof(std::int32_t), "live rays"));
        rays_ = std::move(rays);
        live_ = std::move(live);
    }
    rays_->clear();
    auto* live = reinterpret_cast<std::int32_t*>(live_->data());
    for (int y = 0; y < tiles_.y; ++y)
        for (int x = 0; x < tiles_.x; ++x) {
            const glm::ivec2 of = glm::min(bandSize - rayTile * glm::ivec2(x, y), rayTile);
            live[x + y * tiles_.x] = of.x * of.y;
        }
    uniforms_.voxels = cells.voxels;
    uniforms_.cellsPerUnit = glm::dvec3(cells.voxels) / double(cells.side);
    uniforms_.firstCell = float(-0.5 / double(cells.side));
    uniforms_.eye = eye;
    uniforms_.raysBeginAtEye = eye.w;
    uniforms_.lastCell = cells.count() - 1;
    uniforms_.tiles = glm::ivec4(tiles_, 0, 0);
    return {};
}

shaders::CellInSlot* CellProjector::cellsOfBatch() const {
    return reinterpret_cast<shaders::CellInSlot*>(batches_.data() + ring_[current_].offset);
}

glm::uvec2* CellProjector::itemsOfBatch() const {
    return reinterpret_cast<glm::uvec2*>(batches_.data() + ring_[current_].offset + cellBytes);
}

bool CellProjector::isLive(const PlannedCell& cell) const {
    const auto* live = reinterpret_cast<const std::int32_t*>(live_->data());
    for (int y = cell.tiles.low.y; y < cell.tiles.high.y; ++y)
        for (int x = cell.tiles.low.x; x < cell.tiles.high.x; ++x)
            if (live[x + y * tiles_.x] > 0) return true;
    return false;
}

bool CellProjector::add(const PlannedCell& planned, const CellGrid& cells, const CellPool& pool,
                        int slot) {
    const glm::ivec2 along = planned.tiles.high - planned.tiles.low;
    if (cellCount_ == batchCells_ || itemCount_ + along.x * along.y > itemsInBatch) return false;
    const glm::ivec3 cell = cells.cellAt(planned.cell);
    cellsOfBatch()[cellCount_] = {glm::ivec4(cell, 0),
                                  glm::vec4(glm::vec3(cell * cells.side - pool.border()), 0.0f),
                                  glm::vec4(glm::vec3(pool.slotCorner(slot)), 0.0f)};
    const auto* live = reinterpret_cast<const std::int32_t*>(live_->data());
    glm::uvec2* items = itemsOfBatch();
    for (int y = planned.tiles.low.y; y < planned.tiles.high.y; ++y)
        for (int x = planned.tiles.low.x; x < planned.tiles.high.x; ++x)
            if (live[x + y * tiles_.x] > 0)
                items[itemCount_++] = {unsigned(x) | unsigned(y) << 16, unsigned(cellCount_)};
    ++cellCount_;
    return true;
}

void CellProjector::flush(CellPool& pool, const gpu::ComputeProgram& program) {
    if (itemCount_ > 0) {
        uniforms_.slotSide = float(pool.slotSide());
        uniforms_.atlasPerVoxel = glm::vec4(1.0f / glm::vec3(pool.atlas().size()), 0.0f);
        uniforms_.items = itemCount_;
        block_.write(uniforms_);
        block_.bind(shaders::cellUniformBinding);
        const std::size_t at = ring_[current_].offset;
        batches_.bind(shaders::cellSlotBinding, at, cellBytes);
        batches_.bind(shaders::cellItemBinding, at + cellBytes, batchBytes - cellBytes);
        live_->bind(shaders::liveRayBinding, 0, live_->bytes());
        rays_->bindImage(shaders::rayImage);
        pool.atlas().bind(shaders::volumeUnit);
        program.dispatchGroups(itemCount_);
        ring_[current_].drawn = gpu::Fence::place();
        current_ = (current_ + 1) % ring_.size();
        ring_[current_].drawn.wait();
    }
    pool.drawn();
    cellCount_ = itemCount_ = 0;
}

void CellProjector::project(std::span<const PlannedCell> planned, const CellGrid& cells,
                            CellPool& pool, const gpu::ComputeProgram& program,
                            ResidencyStats& stats) {
    std::vector<CellPool::Planned> shown;
    shown.reserve(planned.size());
    for (const PlannedCell& one : planned)
        shown.push_back({one.cell, one.layer});
    pool.beginFrame(shown);
    std::vector<PlannedCell> layer;
    for (std::size_t begin = 0; begin < planned.size();) {
        std::size_t end = begin;
        layer.clear();
        // The GPU is kept busy with one batch; what those before it have ended is known.
        ring_[(current_ + ring_.size() - 2) % ring_.size()].drawn.wait();
        for (; end < planned.size() && planned[end].layer == planned[begin].layer; ++end)
            if (isLive(planned[end])) layer.push_back(planned[end]);
        drawLayer(layer, cells, pool, program, stats);
        // What comes next is read while this is drawn.
        for (std::size_t next = end; next < planned.size(); ++next)
            if (pool.slotOf(planned[next].cell) < 0 && isLive(planned[next]) &&
                !pool.readAhead(planned[next].cell))
                break;
        begin = end;
    }
    stats.uploaded = int(pool.uploads());
    stats.bytesMoved = pool.uploads() * pool.slotBytes();
    stats.waitedMs = pool.takeWaitedMs();
    stats.resident = pool.capacity();
}

void CellProjector::drawLayer(std::span<const PlannedCell> layer, const CellGrid& cells,
                              CellPool& pool, const gpu::ComputeProgram& program,
                              ResidencyStats& stats) {
    stats.visited += int(layer.size());
    // What is on the GPU already stays there until it is drawn.
    std::vector<PlannedCell> missing;
    for (const PlannedCell& one : layer) {
        const int slot = pool.slotOf(one.cell);
        if (slot < 0) {
            missing.push_back(one);
            continue;
        }
        pool.pin(one.cell);
        if (add(one, cells, pool, slot)) continue;
        flush(pool, program);
        pool.pin(one.cell);
        add(one, cells, pool, slot);
    }
    for (std::size_t i = 0, ahead = 0; i < missing.size(); ++i) {
        for (ahead = std::max(ahead, i); ahead < missing.size(); ++ahead)
            if (!pool.readAhead(missing[ahead].cell)) break;
        int slot = pool.bring(missing[i].cell);
        if (slot < 0) {
            flush(pool, program);
            slot = pool.bring(missing[i].cell);
        }
        if (add(missing[i], cells, pool, slot)) continue;
        flush(pool, program);
        pool.pin(missing[i].cell);
        add(missing[i], cells, pool, slot);
    }
    flush(pool, program);
}

}  // namespace haustra::render
