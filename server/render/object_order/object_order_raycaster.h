// The object-order raycaster: cells of the volume, nearest layer first (dissertation §5.2).
#pragma once

#include "gpu/context.h"
#include "render/scene/raycaster.h"
#include "render/scene/scene.h"

#include <cstddef>
#include <memory>

namespace haustra::render {

struct ObjectOrderOptions {
    int cellSide = 64;            ///< voxels; one of cellSides (cell_grid.h)
    std::size_t budgetBytes = 0;  ///< of GPU memory for cells; 0: as much as they need
    int leafSide = 0;             ///< voxels; a cell's side is a multiple; 0: by the volume's size
    int threads = 0;              ///< that read cells (≤ 0: all cores); changes no pixel
    int batchCells = 4096;        ///< cells that one dispatch draws, 1…4096; changes no pixel
};

/// Fails (badInput) on sides that cannot be chosen.
Result<void> checkObjectOrder(const ObjectOrderOptions& options);
/// Voxels along a leaf of the octree, whose map of distances lets rays leap inside cells: the
/// smaller, the better they leap, and the more memory the map takes.
int leafSideOf(const ObjectOrderOptions& options, glm::ivec3 voxels);

/// What a picture has needed of the volume.
struct ResidencyStats {
    int cells = 0;               ///< of the volume
    int nonEmpty = 0;            ///< that the transfer function may show, or that hold a label
    int inView = 0;              ///<   and that some ray of the picture may meet
    int visited = 0;             ///<   and that a ray has reached before it ended
    int uploaded = 0;            ///< cells brought to the GPU
    std::size_t bytesMoved = 0;  ///<   and what they weigh
    double waitedMs = 0.0;       ///< in which the drawing stood still for them
    int resident = 0;            ///< cells that have room on the GPU
};

/// Only the cells that are seen need be on the GPU, and only for as long as they are drawn: the
/// volume may be larger than the GPU's memory, and mapped from a product than the main memory. A
/// picture is the same to the bit whatever the budget. See cell_pool.h for what stays and goes.
class ObjectOrderRaycaster final : public Raycaster {
public:
    /// Reads the volume once, in order. Of the scene's ranges it takes no notice. Fails (badInput)
    /// on a cell side that cannot be chosen, (device) where the budget holds no cell or the device
    /// has no room. Holds 5 / leafSide³ bytes a voxel of main memory, and 1 / leafSide³ on the GPU:
    /// leaves have 2 voxels a side, 4 over 2²⁸ voxels, 8 over 2³¹.
    static Result<std::unique_ptr<ObjectOrderRaycaster>> create(gpu::Context& context,
                                                                std::shared_ptr<const Scene> scene,
                                                                ObjectOrderOptions options = {});
    ~ObjectOrderRaycaster() override;

    RaycasterKind kind() const override { return RaycasterKind::objectOrder; }
    Result<void> render(const CameraView& view, const Band& band, Image& picture) override;
    std::size_t gpuBytes() const override;
    std::vector<PassTime> passTimes() const override;
    /// Of the last band.
    const ResidencyStats& residency() const;

private:
    struct Impl;
    explicit ObjectOrderRaycaster(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::render
