// Which blocks of voxels a ray may leap over.
#pragma once

#include "core/volume.h"
#include "render/optics/transfer_table.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace haustra::render {

/// Voxels along the side of a leap map's blocks.
inline constexpr int blockSide = 2;

/// Lowest and highest value of each block of s voxels a side: block b spans the centres of voxels
/// s·b … s·(b + 1) along each axis, so that an interpolation inside it reads nothing else.
struct BlockRanges {
    glm::ivec3 size{0};  ///< blocks along each axis, x fastest
    std::vector<std::int16_t> lowHu, highHu;
};

/// Of blocks of `side` voxels. O(voxels), each read (1 + 1/side)² times and in order, so that a
/// memory-mapped volume streams through memory; the same for any number of threads (≤ 0: all
/// cores). At least one voxel.
BlockRanges blockRanges(const Volume<std::int16_t>& volume, int side, int threads);
/// The same of values that are made when they are asked for: row(y, z, values) fills a row of
/// voxels; from any thread, some rows more than once.
using VoxelRow = std::function<void(int y, int z, std::span<std::int16_t> values)>;
BlockRanges blockRanges(glm::ivec3 voxels, const VoxelRow& row, int side, int threads);

/// For each block the Chebyshev distance, in blocks, to the nearest that the transfer function may
/// show: 0 there itself, at most 255. A ray in a block of distance d > 0 may leave the cube of
/// 2d − 1 blocks around it unseen. O(blocks): two chamfer sweeps, exact for this metric.
std::vector<std::uint8_t> leapDistances(const BlockRanges& ranges, const TransferTable& table,
                                        int threads);

}  // namespace haustra::render
