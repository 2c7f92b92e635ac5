// The cells that are on the GPU (dissertation §5.2, figure 5.1).
#pragma once

#include "gpu/streaming.h"
#include "gpu/texture.h"
#include "render/object_order/cell_readers.h"

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace haustra::render {

/// Slots of one 3-D texture, a cell with its border in each. A cell stays until its slot is needed,
/// over as many frames as it can. Belongs to the thread of the context.
///
/// What is replaced, of the cells that the frame has drawn and those it will draw, is what is
/// needed again last: first cells that this frame does not show, the longest unseen first; then
/// those already drawn whose fence has passed, the latest drawn first (the next frame again begins
/// at the front); last those whose turn is farthest.
class CellPool {
public:
    /// `border` voxels on each side beyond those that interpolation in the cell reads. As many
    /// slots as fit into `budgetBytes` (0: what the device gives), until there is one for each
    /// cell; fails (device) where not one does. The atlas's sides are powers of two.
    static Result<std::unique_ptr<CellPool>> create(std::shared_ptr<const CellSource> source,
                                                    const CellGrid& cells, int border,
                                                    std::size_t budgetBytes, int threads);

    int border() const { return border_; }
    int capacity() const { return int(slots_.size()); }
    std::size_t slotBytes() const { return readers_->bufferBytes(); }
    std::size_t gpuBytes() const { return atlas_.bytes(); }
    const gpu::Texture& atlas() const { return atlas_; }
    /// Voxels along a slot's side: the cell's N + 1, and the border on both sides.
    int slotSide() const { return slotSide_; }
    /// First texel of a slot.
    glm::ivec3 slotCorner(int slot) const;

    /// A frame that shows `layers[i]` cells' worth: each cell with its layer.
    struct Planned {
        int cell, layer;
    };
    void beginFrame(std::span<const Planned> planned);
    /// The slot of a cell, or −1.
    int slotOf(int cell) const;
    /// Reads the cell from the volume while others are drawn; false where no buffer is free.
    bool readAhead(int cell);
    /// Brings the cell to the GPU; −1 where all slots hold cells that are to be drawn together with
    /// it (pinned).
    int bring(int cell);
    void pin(int cell);
    /// The pinned cells have been drawn: they may be replaced once the GPU is done.
    void drawn();

    std::size_t uploads() const { return uploads_; }  ///< since beginFrame
    double takeWaitedMs() { return readers_->takeWaitedMs() + std::exchange(waitedMs_, 0.0); }

private:
    static constexpr int none = std::numeric_limits<int>::max();
    struct Slot {
        int cell = -1;
        std::uint64_t seen = 0;  // the last frame that showed it
        int layer = none;        // in this frame; `none`: not shown
        bool pinned = false, drawn = false;
    };
    struct Drawn {
        std::vector<int> slots;
        gpu::Fence fence;
    };
    CellPool(const CellGrid& cells, int border, gpu::Texture atlas, glm::ivec3 slotsAlong,
             std::unique_ptr<CellReaders> readers);
    glm::ivec3 voxelCorner(int cell) const { return cells_.cellAt(cell) * cells_.side - border_; }
    int victim();
    int victimUnseen();
    int victimDrawn();
    int victimFarthest();

    CellGrid cells_;
    int border_, slotSide_;
    gpu::Texture atlas_;
    glm::ivec3 slotsAlong_;
    std::unique_ptr<CellReaders> readers_;
    std::vector<Slot> slots_;
    std::unordered_map<int, int> slotOfCell_;
    std::uint64_t frame_ = 0;
    std::size_t uploads_ = 0, neverUsed_ = 0;
    double waitedMs_ = 0.0;
    std::vector<int> pinned_;
    std::optional<std::vector<int>> unseen_, farthest_;  // the best victim last
    std::vector<Drawn> drawn_;
};

}  // namespace haustra::render
