// The cells that the lumen's boundary passes through.
#pragma once

#include "contouring/cell_cases.h"
#include "core/parallel.h"
#include "core/volume.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haustra::contouring {

/// One cell with corners of both kinds. Its corner 0 is voxel (i, j, k), which may be one less than
/// the grid's first: beyond the grid is outside.
struct BoundaryCell {
    std::int32_t i, j;
    std::int32_t firstVertex;  ///< of its loops' vertices, in the order of the loops
    CellCase inside;
};

/// The boundary's cells by layers (cells of one k), in the order of j, then i.
class BoundaryCells {
public:
    /// O(voxels), bound by memory. `lumen` must be alive only during the call.
    BoundaryCells(const Volume<std::uint8_t>& lumen, int threads);

    /// Cells have −1 ≤ i, j, k < gridSize.
    glm::ivec3 gridSize() const { return size_; }
    /// Layers are numbered from 0 for k = −1.
    int layers() const { return size_.z + 1; }
    static int ofLayer(int layer) { return layer - 1; }
    std::span<const BoundaryCell> layer(int n) const {
        return {cells_.data() + begin_[std::size_t(n)],
                begin_[std::size_t(n) + 1] - begin_[std::size_t(n)]};
    }
    std::span<const BoundaryCell> cells() const { return cells_; }
    /// body(cell, k) for each cell, on several threads.
    template <class Body>
    void forEach(int threads, const Body& body) const {
        parallelFor(std::size_t(layers()), 4, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) {
                for (const BoundaryCell& cell : layer(int(n)))
                    body(cell, ofLayer(int(n)));
            }
        });
    }
    /// Place of a layer's first cell among all.
    std::size_t layerBegin(int n) const { return begin_[std::size_t(n)]; }
    std::size_t vertexCount() const { return vertexCount_; }
    /// The least i, j and k of any cell; there must be one.
    glm::ivec3 low() const;

private:
    glm::ivec3 size_;
    std::vector<BoundaryCell> cells_;
    std::vector<std::size_t> begin_;
    std::size_t vertexCount_ = 0;
};

/// Finds a cell of two neighbouring layers by its place in constant time. One to a thread.
class LayerPair {
public:
    explicit LayerPair(const BoundaryCells& cells);
    /// Looks at layers n − 1 and n from here on.
    void moveTo(int n);
    /// The cell's place among all cells, at (i, j) of layer n (below = false) or n − 1; −1: none.
    std::int32_t find(int i, int j, bool below) const {
        return maps_[below ? 1 - current_ : current_][place(i, j)];
    }

private:
    std::size_t place(int i, int j) const {
        return std::size_t(i + 1) + std::size_t(width_) * std::size_t(j + 1);
    }
    void fill(int map, int layer);

    const BoundaryCells& cells_;
    int width_;
    std::vector<std::int32_t> maps_[2];
    int layerOf_[2] = {-1, -1};
    int current_ = 0;
};

}  // namespace haustra::contouring
