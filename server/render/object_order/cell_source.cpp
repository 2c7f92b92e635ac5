#include "render/object_order/cell_source.h"

#include "render/scene/stored_value.h"

#include <algorithm>

namespace haustra::render {

void ScanCells::read(const VoxelBox& box, std::byte* texels) const {
    auto* out = reinterpret_cast<std::uint16_t*>(texels);
    const Grid& grid = volume_.grid();
    const glm::ivec2 inside = insideOfRow(box, grid.size);
    const std::int16_t* voxels = volume_.voxels().data();
    forEachRow(box, grid.size, [&](int y, int z, std::size_t texel) {
        const std::int16_t* from = voxels + grid.index(box.corner.x + inside.x, y, z);
        std::uint16_t* row = out + texel;
        for (int x = inside.x; x < inside.y; ++x)
            row[x] = encodeHu(from[x - inside.x]);
        std::fill(row, row + inside.x, row[inside.x]);
        std::fill(row + inside.y, row + box.side, row[inside.y - 1]);
    });
}

}  // namespace haustra::render
