// The order of a grid's axes. The stages take axis k for the slices', near the patient's z; a NIfTI
// file, or a series of coronal or sagittal images, may have it otherwise.
#pragma once

#include "core/parallel.h"
#include "core/volume.h"

#include <array>
#include <cstdint>

namespace haustra::pipeline {

/// Axis a of a reordered grid is axis order[a] of the grid it comes from.
using AxisOrder = std::array<int, 3>;

inline constexpr AxisOrder sameOrder{0, 1, 2};

/// The order that makes k the axis nearest to the patient's z, of either direction, and i the one
/// of the other two nearest to x. Axes as near as each other stay in their order, so that an axial
/// grid gives sameOrder.
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
    const std::array<std::size_t, 3> strides{1, std::size_t(from.size.x),
                                             std::size_t(from.size.x) * std::size_t(from.size.y)};
    const auto strideOf = [&](int axis) { return strides[std::size_t(order[std::size_t(axis)])]; };
    Volume<T> result(to);
    const auto voxels = result.writable();
    const auto rowLength = std::size_t(to.size.x), rowsOfSlice = std::size_t(to.size.y);
    parallelFor(rowsOfSlice * std::size_t(to.size.z), 64, threads,
                [&](std::size_t begin, std::size_t end) {
                    for (std::size_t row = begin; row < end; ++row) {
                        const std::size_t first =
                            row % rowsOfSlice * strideOf(1) + row / rowsOfSlice * strideOf(2);
                        for (std::size_t i = 0; i < rowLength; ++i)
                            voxels[row * rowLength + i] = volume[first + i * strideOf(0)];
                    }
                });
    return result;
}

}  // namespace haustra::pipeline
