#include "render/object_order/frame_plan.h"

#include <algorithm>

namespace haustra::render {

std::vector<PlannedCell> planFrame(const CellGrid& cells, const std::vector<std::uint8_t>& needed,
                                   const Grid& grid, const Camera& camera, glm::ivec2 pictureSize,
                                   int firstRow, int rows) {
    const Footprint footprint(camera, grid, pictureSize);
    const glm::ivec3 source = sourceCell(cells, camera, grid);
    std::vector<PlannedCell> planned;
    const int layers = lastLayer(cells, source);
    for (int layer = 0; layer <= layers; ++layer)
        forEachCellOfLayer(cells, source, layer, [&](glm::ivec3 cell) {
            const int index = cells.index(cell);
            if (!needed[std::size_t(index)]) return;
            PixelRect seen = footprint.of(cells.low(cell), cells.high(cell));
            seen.low.y = std::max(seen.low.y - firstRow, 0);
            seen.high.y = std::min(seen.high.y - firstRow, rows);
            if (seen.empty()) return;
            planned.push_back(
                {index, layer, {seen.low / rayTile, (seen.high + rayTile - 1) / rayTile}});
        });
    return planned;
}

}  // namespace haustra::render
