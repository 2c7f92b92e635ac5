#include "phantom/cell_grid.h"

#include "core/voxel_sweep.h"

namespace haustra::phantom {

CellGrid::CellGrid(std::span<const Box> boxes, double cellMm) : cellMm_(cellMm) {
    if (boxes.empty()) return;
    Box all = boxes.front();
    for (const Box& box : boxes)
        all.low = glm::min(all.low, box.low), all.high = glm::max(all.high, box.high);
    lowMm_ = all.low;
    cells_ = cellOf(all.high) + 1;
    begin_.assign(std::size_t(cells_.x) * cells_.y * cells_.z + 1, 0);
    const auto eachCell = [&](const Box& box, const auto& body) {
        const glm::ivec3 lo = cellOf(box.low), hi = cellOf(box.high);
        visitBox(lo, hi, [&](glm::ivec3 cell) { body(indexOf(cell)); });
    };
    for (const Box& box : boxes)
        eachCell(box, [&](std::size_t cell) { ++begin_[cell + 1]; });
    for (std::size_t cell = 1; cell < begin_.size(); ++cell)
        begin_[cell] += begin_[cell - 1];
    items_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t n = 0; n < boxes.size(); ++n)
        eachCell(boxes[n], [&](std::size_t cell) { items_[next[cell]++] = n; });
}

}  // namespace haustra::phantom
