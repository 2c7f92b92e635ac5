// Which blocks of voxels a ray may leap over.
#pragma once

#include "core/volume.h"
#include "render/optics/transfer_table.h"

#include <cstdint>
#include <vector>

namespace haustra::render {

/// Voxels along a block's side. Block b spans the centres of voxels 2b … 2b + 2 along each axis,
/// so that an interpolation inside it reads nothing else.
inline constexpr int blockSide = 2;

/// Lowest and highest value of each block.
struct BlockRanges {
    glm::ivec3 size{0};  ///< blocks along each axis, x fastest
    std::vector<std::int16_t> lowHu, highHu;
};

/// O(voxels); the same for any number of threads.
BlockRanges blockRanges(const Volume<std::int16_t>& volume, int threads);

/// For each block the Chebyshev distance, in blocks, to the nearest that the transfer function may
/// show: 0 there itself, at most 255. A ray in a block of distance d > 0 may leave the cube of
/// 2d − 1 blocks around it unseen. O(blocks): two chamfer sweeps, exact for this metric.
std::vector<std::uint8_t> leapDistances(const BlockRanges& ranges, const TransferTable& table,
                                        int threads);

}  // namespace haustra::render
