#include "pipeline/axial_order.h"

#include <algorithm>
#include <cmath>

namespace haustra::pipeline {

std::vector<AxisOrder> allAxisOrders() {
    std::vector<AxisOrder> orders;
    AxisOrder order;
    do {
        for (int sides = 0; sides < 8; ++sides) {
            order.reversed = {(sides & 1) != 0, (sides & 2) != 0, (sides & 4) != 0};
            orders.push_back(order);
        }
    } while (std::next_permutation(order.from.begin(), order.from.end()));
    return orders;
}

AxisOrder axialOrder(const Grid& grid) {
    const auto along = [&](int axis, int patientAxis) {
        return glm::normalize(glm::dvec3(grid.patientFromVoxel[axis]))[patientAxis];
    };
    int k = 2;
    for (int axis = 0; axis < 2; ++axis) {
        if (std::abs(along(axis, 2)) > std::abs(along(k, 2))) k = axis;
    }
    int i = k == 0 ? 1 : 0, j = 3 - k - i;
    if (std::abs(along(j, 0)) > std::abs(along(i, 0))) std::swap(i, j);
    return {{i, j, k}, {along(i, 0) < 0.0, along(j, 1) < 0.0, along(k, 2) < 0.0}};
}

Grid reordered(const Grid& grid, const AxisOrder& order) {
    Grid result = grid;
    for (int axis = 0; axis < 3; ++axis) {
        const int from = order.from[std::size_t(axis)];
        const bool reversed = order.reversed[std::size_t(axis)];
        const glm::dvec4 step = grid.patientFromVoxel[from];
        result.size[axis] = grid.size[from];
        result.patientFromVoxel[axis] = reversed ? -step : step;
        if (reversed) result.patientFromVoxel[3] += double(grid.size[from] - 1) * step;
    }
    return result;
}

}  // namespace haustra::pipeline
