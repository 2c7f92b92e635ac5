// Short walks along the grid's axes, across the partial volume between one body and the next.
#pragma once

#include "core/grid.h"

#include <cstddef>

namespace haustra::segmentation {

/// From the voxel `index` along ± each axis, up to `mostBetween` voxels and then one more, to the
/// first for which `hit(index)` holds: visit(axis, sign, step, index of the hit).
template <class Hit, class Visit>
void walkAxes(const Grid& grid, std::size_t index, int mostBetween, Hit&& hit, Visit&& visit) {
    const std::size_t strides[3] = {1, std::size_t(grid.size.x),
                                    std::size_t(grid.size.x) * std::size_t(grid.size.y)};
    const glm::ivec3 v = grid.voxelAt(index);
    for (int axis = 0; axis < 3; ++axis) {
        for (int sign : {-1, 1}) {
            std::size_t at = index;
            for (int step = 1; step <= mostBetween + 1; ++step) {
                const int n = v[axis] + sign * step;
                if (n < 0 || n >= grid.size[axis]) break;
                at = sign > 0 ? at + strides[axis] : at - strides[axis];
                if (hit(at)) {
                    visit(axis, sign, step, at);
                    break;
                }
            }
        }
    }
}

/// visit(index) of each of the up to six neighbours.
template <class Visit>
void visitNeighbours(const Grid& grid, std::size_t index, Visit&& visit) {
    walkAxes(
        grid, index, 0, [](std::size_t) { return true; },
        [&](int, int, int, std::size_t at) { visit(at); });
}

}  // namespace haustra::segmentation
