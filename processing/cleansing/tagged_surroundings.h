// The voxels that the tagged lumen can have touched through the scanner's blur.
#pragma once

#include "core/volume.h"

#include <cstdint>
#include <vector>

namespace haustra::cleansing {

/// Voxels by their distance from the tagged lumen in 26-neighbour steps: shell 0 is the voxels
/// labelled tagged, shell n those n steps away. Each shell in memory order.
struct TaggedSurroundings {
    static constexpr int reach = 3;
    std::vector<std::vector<std::uint32_t>> shells;
};

/// O(voxels). The grid must have fewer than 2^32 voxels.
TaggedSurroundings taggedSurroundings(const Volume<std::uint8_t>& segmentation, int threads);

}  // namespace haustra::cleansing
