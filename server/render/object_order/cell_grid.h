// A volume cut into cells, and the order in which rays come through them (dissertation §5.2.2).
#pragma once

#include "core/grid.h"
#include "render/scene/picture.h"

#include <cstdlib>

#include <glm/glm.hpp>

namespace haustra::render {

/// Voxels along a cell's side that can be chosen.
inline constexpr int cellSides[] = {16, 32, 64, 128};

/// Cell k spans the centres of voxels k·side … (k + 1)·side along each axis; the outermost cells
/// also hold what lies between the last centres and the volume's faces. A sample on a face between
/// two cells belongs to one of them.
struct CellGrid {
    glm::ivec3 voxels{0};
    int side = 64;

    glm::ivec3 count() const { return glm::max((voxels - 1 + side - 1) / side, glm::ivec3(1)); }
    int cells() const { return count().x * count().y * count().z; }
    int index(glm::ivec3 cell) const { return cell.x + count().x * (cell.y + count().y * cell.z); }
    glm::ivec3 cellAt(int index) const {
        const glm::ivec3 n = count();
        return {index % n.x, index / n.x % n.y, index / n.x / n.y};
    }
    /// Voxel coordinates of a cell's corners, as far as samples in it reach.
    glm::dvec3 low(glm::ivec3 cell) const;
    glm::dvec3 high(glm::ivec3 cell) const;
};

/// Where a camera's rays begin among the cells: in, or nearest to, the camera's cell; of parallel
/// rays, the corner that the first of them meets.
///
/// Along a ray each voxel coordinate only grows or only falls, and from the source on it only
/// recedes from the source's: wherever the ray passes from cell to cell through a face, the
/// Manhattan distance to the source grows by one. So a ray meets at most one cell of each distance,
/// cells of one distance never hide each other, and what is nearer is drawn first.
glm::ivec3 sourceCell(const CellGrid& cells, const Camera& camera, const Grid& grid);

/// Manhattan distance, the layer of a cell.
inline int layerOf(glm::ivec3 cell, glm::ivec3 source) {
    return std::abs(cell.x - source.x) + std::abs(cell.y - source.y) + std::abs(cell.z - source.z);
}

/// Calls visit(cell) for every cell of the layer, the surface of an octahedron: what propagating
/// from face to face reaches at that step, in no time for what it has reached before.
template <class Visit>
void forEachCellOfLayer(const CellGrid& cells, glm::ivec3 source, int layer, Visit&& visit) {
    const glm::ivec3 last = cells.count() - 1;
    for (int dz = -std::min(layer, source.z); dz <= std::min(layer, last.z - source.z); ++dz) {
        const int inSlice = layer - std::abs(dz);
        const int lowY = -std::min(inSlice, source.y), highY = std::min(inSlice, last.y - source.y);
        for (int dy = lowY; dy <= highY; ++dy) {
            const int dx = inSlice - std::abs(dy);
            const glm::ivec3 row(source.x, source.y + dy, source.z + dz);
            if (source.x - dx >= 0) visit(row - glm::ivec3(dx, 0, 0));
            if (dx > 0 && source.x + dx <= last.x) visit(row + glm::ivec3(dx, 0, 0));
        }
    }
}

/// Layers from 0 to this may hold cells.
inline int lastLayer(const CellGrid& cells, glm::ivec3 source) {
    const glm::ivec3 most = glm::max(source, cells.count() - 1 - source);
    return most.x + most.y + most.z;
}

}  // namespace haustra::render
