// The cells of one picture, in the order in which they are drawn.
#pragma once

#include "render/object_order/cell_grid.h"
#include "render/object_order/footprint.h"

#include <cstdint>
#include <vector>

namespace haustra::render {

/// Pixels along the side of a tile, whose rays are followed together.
inline constexpr int rayTile = 8;

struct PlannedCell {
    int cell = 0;
    int layer = 0;
    PixelRect tiles;  ///< of the band
};

/// All cells that `needed` says (by index) and some ray of the band's rows may meet, layer by
/// layer.
std::vector<PlannedCell> planFrame(const CellGrid& cells, const std::vector<std::uint8_t>& needed,
                                   const Grid& grid, const Camera& camera, glm::ivec2 pictureSize,
                                   int firstRow, int rows);

}  // namespace haustra::render
