// Draws cells layer by layer, and brings them to the GPU in time (dissertation §5.2, figure 5.2).
#pragma once

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/streaming.h"
#include "gpu/texture.h"
#include "render/object_order/cell_pool.h"
#include "render/object_order/frame_plan.h"
#include "render/object_order/object_order_raycaster.h"
#include "shaders/cell_uniforms.h"

#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace haustra::render {

inline constexpr int mostBatchCells = 4096;

/// What a band's rays have gathered, and the commands that go on with them. Belongs to the thread
/// of the context.
class CellProjector {
public:
    /// `batchCells`: cells that one dispatch draws, 1…mostBatchCells.
    static Result<CellProjector> create(int batchCells);

    /// Begins a band: no ray has met anything. `eye`: in cells, w 1 where all rays begin there.
    Result<void> begin(glm::ivec2 bandSize, const CellGrid& cells, glm::vec4 eye);
    /// Runs `program` (cell_rays.comp or the like, everything else bound) over the cells, which
    /// come layer by layer, and leaves out those that no live ray meets. While a layer is drawn,
    /// the cells of the next ones are read.
    void project(std::span<const PlannedCell> planned, const CellGrid& cells, CellPool& pool,
                 const gpu::ComputeProgram& program, ResidencyStats& stats);
    const gpu::Texture& rays() const { return *rays_; }
    std::size_t gpuBytes() const;

private:
    /// Cells and items of one dispatch, in memory that the GPU reads.
    struct Batch {
        std::size_t offset = 0;
        gpu::Fence drawn;
    };
    CellProjector(gpu::MappedBuffer batches, gpu::UniformBuffer block, int batchCells);
    bool isLive(const PlannedCell& cell) const;
    bool add(const PlannedCell& cell, const CellGrid& cells, const CellPool& pool, int slot);
    void flush(CellPool& pool, const gpu::ComputeProgram& program);
    void drawLayer(std::span<const PlannedCell> layer, const CellGrid& cells, CellPool& pool,
                   const gpu::ComputeProgram& program, ResidencyStats& stats);
    shaders::CellInSlot* cellsOfBatch() const;
    glm::uvec2* itemsOfBatch() const;

    gpu::MappedBuffer batches_;
    gpu::UniformBuffer block_;
    std::vector<Batch> ring_;
    int batchCells_;
    std::size_t current_ = 0;
    int cellCount_ = 0, itemCount_ = 0;

    shaders::CellUniforms uniforms_{};
    glm::ivec2 tiles_{0};
    std::optional<gpu::Texture> rays_;
    std::optional<gpu::MappedBuffer> live_;
};

}  // namespace haustra::render
