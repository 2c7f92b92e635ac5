// The order of a grid's axes. The stages take axis k for the slices', near the patient's z; a NIfTI
// file, or a series of coronal or sagittal images, may have it otherwise, and any series may run
// the other way along an axis. One order for all makes one scan's result the same however it is
// stored.
#pragma once

#include "core/parallel.h"
#include "core/volume.h"

#include <array>
#include <cstdint>
#include <vector>

namespace haustra::pipeline {

/// Axis a of a reordered grid is axis from[a] of the grid it comes from; where reversed[a], run
/// through from its last voxel to its first.
struct AxisOrder {
    std::array<int, 3> from{0, 1, 2};
    std::array<bool, 3> reversed{false, false, false};

    bool operator==(const AxisOrder&) const = default;
};

inline constexpr AxisOrder sameOrder{};

/// All 48 of them, sameOrder first.
std::vector<AxisOrder> allAxisOrders();

/// The order in which i, j and k run towards the patient's left, back and head (LPS): k is the axis
/// nearest to the patient's z, and i the one of the other two nearest to x. Axes as near as each
/// other stay in their order. An axial grid of that kind gives sameOrder.
AxisOrder axialOrder(const Grid& grid);

/// The grid with its axes in another order: the same voxels at the same places in the patient.
Grid reordered(const Grid& grid, const AxisOrder& order);

/// The volume on the reordered grid: each voxel keeps its value and its place in the patient. In
/// the same order it is the same memory. O(voxels); the same for any number of threads.
template <class T>
Volume<T> reordered(Volume<T> volume, const AxisOrder& order, int threads) {
    if (order == sameOrder) return volume;
    const Grid& from = volume.grid();
    const Grid to = reordered(from, order);
    const std::array<std::ptrdiff_t, 3> strides{
        1, std::ptrdiff_t(from.size.x), std::ptrdiff_t(from.size.x) * std::ptrdiff_t(from.size.y)};
    // Of the axes of `to`, in the memory of `from`, and where its first voxel is there.
    std::array<std::ptrdiff_t, 3> stride{};
    std::ptrdiff_t start = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        stride[axis] = strides[std::size_t(order.from[axis])];
        if (!order.reversed[axis]) continue;
        start += std::ptrdiff_t(to.size[int(axis)] - 1) * stride[axis];
        stride[axis] = -stride[axis];
    }
    Volume<T> result(to);
    const auto voxels = result.writable();
    const auto rowLength = std::size_t(to.size.x), rowsOfSlice = std::size_t(to.size.y);
    parallelFor(
        rowsOfSlice * std::size_t(to.size.z), 64, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) {
                const std::ptrdiff_t first = start + std::ptrdiff_t(row % rowsOfSlice) * stride[1] +
                                             std::ptrdiff_t(row / rowsOfSlice) * stride[2];
                for (std::size_t i = 0; i < rowLength; ++i)
                    voxels[row * rowLength + i] =
                        volume[std::size_t(first + std::ptrdiff_t(i) * stride[0])];
            }
        });
    return result;
}

}  // namespace haustra::pipeline
