#include "pipeline/axial_order.h"

#include <algorithm>
#include <cmath>

namespace haustra::pipeline {

AxisOrder axialOrder(const Grid& grid) {
    const auto along = [&](int axis, int patientAxis) {
        const auto direction = glm::normalize(glm::dvec3(grid.patientFromVoxel[axis]));
        return std::abs(direction[patientAxis]);
    };
    int k = 2;
    for (int axis = 0; axis < 2; ++axis) {
        if (along(axis, 2) > along(k, 2)) k = axis;
    }
    int i = k == 0 ? 1 : 0, j = 3 - k - i;
    if (along(j, 0) > along(i, 0)) std::swap(i, j);
    return {i, j, k};
}

Grid reordered(const Grid& grid, const AxisOrder& order) {
    Grid result = grid;
    for (int axis = 0; axis < 3; ++axis) {
        result.size[axis] = grid.size[order[std::size_t(axis)]];
        result.patientFromVoxel[axis] = grid.patientFromVoxel[order[std::size_t(axis)]];
    }
    return result;
}

}  // namespace haustra::pipeline
