// A field that changes slowly, kept on coarse cells.
#pragma once

#include "core/grid.h"

#include <array>
#include <span>
#include <vector>

namespace haustra::cleansing {

/// A smooth field over a grid, kept on cells and interpolated between their centres.
class SmoothField {
public:
    SmoothField() = default;
    SmoothField(const Grid& grid, glm::ivec3 voxelsPerCell);

    glm::ivec3 cells() const { return cells_; }
    std::size_t cellOf(int i, int j, int k) const {
        return cellIndex(i / perCell_.x, j / perCell_.y, k / perCell_.z);
    }
    std::size_t cellIndex(int i, int j, int k) const {
        return std::size_t(i) +
               std::size_t(cells_.x) * (std::size_t(j) + std::size_t(cells_.y) * std::size_t(k));
    }
    glm::ivec3 voxelsPerCell() const { return perCell_; }
    float at(int i, int j, int k) const;
    /// The values at `first` and the voxels after it along i.
    void row(glm::ivec3 first, std::span<float> values) const;
    bool empty() const { return values_.empty(); }
    std::vector<float>& values() { return values_; }

private:
    /// The cells between whose centres a voxel's lies, and the second one's share.
    struct Between {
        int lo, hi;
        float share;
    };

    glm::ivec3 perCell_{1}, cells_{0};
    std::array<std::vector<Between>, 3> between_;  // of the voxels along each axis
    std::vector<float> values_;
};

/// Convolves cells (`size` of them along each axis, i fastest) along one axis with a kernel of an
/// odd number of weights; nothing lies beyond the cells. O(cells · weights).
void convolveAxis(std::vector<float>& cells, glm::ivec3 size, int axis,
                  std::span<const float> kernel, int threads);

}  // namespace haustra::cleansing
