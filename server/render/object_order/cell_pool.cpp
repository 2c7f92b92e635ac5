#include "render/object_order/cell_pool.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace haustra::render {

namespace {

// Staging: enough for the reading to keep ahead of the drawing, and no more memory than this.
constexpr std::size_t stagingBytes = std::size_t(64) << 20;
constexpr int leastStaging = 4, mostStaging = 32;

/// Texels along an atlas's sides. They are powers of two: dividing by them rounds nothing, so that
/// a sample is the same to the bit in whichever slot its cell is.
struct Shape {
    glm::ivec3 texels{0};
    std::size_t slots = 0;
    std::size_t count() const {
        return std::size_t(texels.x) * std::size_t(texels.y) * std::size_t(texels.z);
    }
};

/// The one with most slots, though not more than `wanted`, in at most `mostTexels`; among these
/// the smallest. No slots where none fits.
Shape bestShape(int slotSide, std::size_t wanted, std::size_t mostTexels, int longestSide) {
    Shape best;
    const auto slotsOf = [&](int texels) { return std::size_t(texels / slotSide); };
    for (int z = 1; z <= longestSide; z *= 2)
        for (int y = z; y <= longestSide; y *= 2)
            for (int x = y; x <= longestSide; x *= 2) {
                const Shape shape{{x, y, z}, slotsOf(x) * slotsOf(y) * slotsOf(z)};
                if (shape.count() > mostTexels) break;
                const std::size_t useful = std::min(shape.slots, wanted);
                const std::size_t known = std::min(best.slots, wanted);
                if (useful > known || (useful == known && shape.count() < best.count()))
                    best = shape;
            }
    return best;
}

}  // namespace

Result<std::unique_ptr<CellPool>> CellPool::create(std::shared_ptr<const CellSource> source,
                                                   const CellGrid& cells, int border,
                                                   std::size_t budgetBytes, int threads) {
    const int side = cells.side + 1 + 2 * border;
    const std::size_t slotBytes =
        source->texelBytes() * std::size_t(side) * std::size_t(side) * std::size_t(side);
    const std::size_t texelBytes = source->texelBytes();
    std::size_t most = budgetBytes ? budgetBytes / texelBytes : std::size_t(1) << 40;
    const int longest = gpu::maxTextureSide3d();
    while (true) {
        const Shape shape = bestShape(side, std::size_t(cells.cells()), most, longest);
        if (shape.slots == 0)
            return fail(ErrorKind::device,
                        "no cell of " + std::to_string(cells.side) + "^3 voxels has room in " +
                            std::to_string(texelBytes * most >> 20) + " MiB of GPU memory",
                        "object-order raycaster");
        auto atlas = gpu::Texture::create(3, shape.texels, source->format(), gpu::Filter::linear,
                                          "cells on the GPU");
        if (!atlas) {
            most = shape.count() / 2;
            continue;
        }
        const int buffers = std::clamp(int(stagingBytes / slotBytes), leastStaging, mostStaging);
        auto readers = TRY(CellReaders::create(std::move(source), side, buffers, threads));
        return std::unique_ptr<CellPool>(new CellPool(cells, border, std::move(*atlas),
                                                      shape.texels / side, std::move(readers)));
    }
}

CellPool::CellPool(const CellGrid& cells, int border, gpu::Texture atlas, glm::ivec3 slotsAlong,
                   std::unique_ptr<CellReaders> readers)
    : cells_(cells),
      border_(border),
      slotSide_(cells.side + 1 + 2 * border),
      atlas_(std::move(atlas)),
      slotsAlong_(slotsAlong),
      readers_(std::move(readers)),
      slots_(std::size_t(slotsAlong.x) * std::size_t(slotsAlong.y) * std::size_t(slotsAlong.z)) {}

glm::ivec3 CellPool::slotCorner(int slot) const {
    const int row = slot / slotsAlong_.x;
    return slotSide_ * glm::ivec3(slot % slotsAlong_.x, row % slotsAlong_.y, row / slotsAlong_.y);
}

void CellPool::beginFrame(std::span<const Planned> planned) {
    ++frame_;
    uploads_ = 0;
    unseen_.reset();
    farthest_.reset();
    drawn_.clear();
    for (const int slot : std::exchange(pinned_, {}))
        slots_[std::size_t(slot)].pinned = false;
    for (Slot& slot : slots_)
        slot.layer = none, slot.drawn = false;
    for (const Planned& one : planned) {
        const auto found = slotOfCell_.find(one.cell);
        if (found == slotOfCell_.end()) continue;
        Slot& slot = slots_[std::size_t(found->second)];
        slot.layer = one.layer;
        slot.seen = frame_;
    }
    readers_->giveUp();
}

int CellPool::slotOf(int cell) const {
    const auto found = slotOfCell_.find(cell);
    return found == slotOfCell_.end() ? -1 : found->second;
}

bool CellPool::readAhead(int cell) {
    return readers_->isAhead(cell) || readers_->readAhead(cell, voxelCorner(cell));
}

void CellPool::pin(int cell) {
    const int slot = slotOf(cell);
    if (std::exchange(slots_[std::size_t(slot)].pinned, true)) return;
    pinned_.push_back(slot);
}

int CellPool::bring(int cell) {
    const int index = victim();
    if (index < 0) return -1;
    Slot& slot = slots_[std::size_t(index)];
    if (slot.cell >= 0) slotOfCell_.erase(slot.cell);
    slot = Slot{cell, frame_, 0, false, false};
    slotOfCell_[cell] = index;
    readers_->upload(cell, voxelCorner(cell), atlas_, slotCorner(index));
    ++uploads_;
    pin(cell);
    return index;
}

void CellPool::drawn() {
    for (const int slot : pinned_) {
        slots_[std::size_t(slot)].pinned = false;
        slots_[std::size_t(slot)].drawn = true;
    }
    drawn_.push_back({std::exchange(pinned_, {}), gpu::Fence::place()});
}

int CellPool::victim() {
    if (neverUsed_ < slots_.size()) return int(neverUsed_++);
    int slot = victimUnseen();
    if (slot < 0) slot = victimDrawn();
    if (slot < 0) slot = victimFarthest();
    return slot;
}

int CellPool::victimUnseen() {
    if (!unseen_) {
        unseen_.emplace();
        for (std::size_t i = 0; i < slots_.size(); ++i)
            if (slots_[i].seen != frame_) unseen_->push_back(int(i));
        std::stable_sort(unseen_->begin(), unseen_->end(), [&](int a, int b) {
            return slots_[std::size_t(a)].seen > slots_[std::size_t(b)].seen;
        });
    }
    if (unseen_->empty()) return -1;
    const int slot = unseen_->back();
    unseen_->pop_back();
    return slot;
}

int CellPool::victimDrawn() {
    // A cell that did not fit into a batch was pinned through its drawing, and waits for the next.
    for (Drawn& batch : drawn_)
        std::erase_if(batch.slots, [&](int slot) { return slots_[std::size_t(slot)].pinned; });
    while (!drawn_.empty() && drawn_.back().slots.empty())
        drawn_.pop_back();
    if (drawn_.empty()) return -1;
    // The latest whose fence has passed; where none has, the first, which will pass first.
    auto from = std::find_if(drawn_.rbegin(), drawn_.rend(), [](Drawn& batch) {
        return !batch.slots.empty() && batch.fence.passed();
    });
    if (from == drawn_.rend()) {
        from = std::find_if(drawn_.rbegin(), drawn_.rend(),
                            [](const Drawn& batch) { return !batch.slots.empty(); });
        const auto start = std::chrono::steady_clock::now();
        from->fence.wait();
        waitedMs_ +=
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count();
    }
    const int slot = from->slots.back();
    from->slots.pop_back();
    return slot;
}

int CellPool::victimFarthest() {
    if (!farthest_) {
        farthest_.emplace();
        for (std::size_t i = 0; i < slots_.size(); ++i)
            if (!slots_[i].drawn && !slots_[i].pinned) farthest_->push_back(int(i));
        std::stable_sort(farthest_->begin(), farthest_->end(), [&](int a, int b) {
            return slots_[std::size_t(a)].layer < slots_[std::size_t(b)].layer;
        });
    }
    while (!farthest_->empty()) {
        const int index = farthest_->back();
        farthest_->pop_back();
        const Slot& slot = slots_[std::size_t(index)];
        if (!slot.drawn && !slot.pinned && slot.layer != none) return index;
    }
    return -1;
}

}  // namespace haustra::render
