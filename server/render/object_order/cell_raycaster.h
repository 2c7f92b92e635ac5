// What the raycasters that go cell by cell have in common: from a plan to a picture.
#pragma once

#include "gpu/context.h"
#include "render/object_order/cell_pool.h"
#include "render/object_order/cell_projector.h"
#include "render/optics/classification.h"
#include "render/scene/picture.h"
#include "render/scene/raycaster.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace haustra::render {

/// A volume as one transfer function or choice of labels shows it: what rays look up, and the cells
/// that they need.
struct ShownCells {
    Classification classified;
    std::vector<std::uint8_t> needed;  ///< by cell
    int count = 0;                     ///< of those needed
};

/// Belongs to the thread of the context.
class CellRaycaster {
public:
    /// `leaves` and `leafSide`: of the octree that ShownCells are classified by. Fails as CellPool
    /// and Texture do.
    static Result<CellRaycaster> create(gpu::Context& context, const Grid& grid,
                                        std::shared_ptr<const CellSource> source,
                                        const ObjectOrderOptions& options, glm::ivec3 leaves,
                                        int leafSide);

    const CellGrid& cells() const { return cells_; }
    /// `cast` is a variant of cell_rays.comp, `resolve` of cell_picture.comp; `border` is as
    /// CellPool's. View and band have been checked.
    Result<void> render(const CameraView& view, const Band& band, const ShownCells& shown,
                        int border, const gpu::ComputeProgram& cast,
                        const gpu::ComputeProgram& resolve, Image& image);
    /// Forgets the cells that are on the GPU: what they hold has changed.
    void forget() { pool_.reset(); }

    std::size_t gpuBytes() const;
    const std::vector<PassTime>& passTimes() const { return times_; }
    const ResidencyStats& residency() const { return stats_; }

private:
    CellRaycaster(gpu::Context& context, const Grid& grid, std::shared_ptr<const CellSource> source,
                  const ObjectOrderOptions& options, glm::ivec3 leaves, int leafSide,
                  CellProjector projector, gpu::UniformBuffer marchBlock);
    Result<void> makePool(int border);
    Result<void> makeTargets(const CameraView& view, glm::ivec2 size);
    void bind(const CameraView& view, const Band& band, const ShownCells& shown);
    glm::vec4 eyeInCells(const CameraView& view) const;

    gpu::Context* context_;
    Grid grid_;
    CellGrid cells_;
    std::shared_ptr<const CellSource> source_;
    ObjectOrderOptions options_;
    glm::ivec3 leaves_;
    int leafSide_;
    CellProjector projector_;
    gpu::UniformBuffer marchBlock_;
    std::unique_ptr<CellPool> pool_;
    std::optional<gpu::Texture> picture_, backdropTexture_;
    std::shared_ptr<const Backdrop> backdrop_;  // what the texture holds
    ResidencyStats stats_;
    std::vector<PassTime> times_;
};

}  // namespace haustra::render
