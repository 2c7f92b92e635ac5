// The voxels that the tagged lumen can have touched through the scanner's blur.
#pragma once

#include "core/parallel.h"
#include "core/volume.h"

#include <cstdint>
#include <vector>

namespace haustra::cleansing {

/// Voxels by their distance from the tagged lumen: shell 0 is the voxels labelled tagged, each
/// other the neighbours of the one before, out to where the blur reaches from within a border's
/// voxel (blurReachVoxels) along each axis. Axes with larger voxels take part in fewer shells. Each
/// shell in memory order.
struct TaggedSurroundings {
    std::vector<std::vector<std::uint32_t>> shells;
    int besideShells = 1;  ///< shells 1 to this one lie within 0.75 mm, or touch the tagging
};

/// Calls visit(index) for each voxel of all shells; what it writes must be the voxel's own. `grain`
/// is how many voxels a thread takes at once.
template <class Visit>
void forEachVoxel(const TaggedSurroundings& around, std::size_t grain, int threads,
                  const Visit& visit) {
    for (const auto& shell : around.shells) {
        parallelFor(shell.size(), grain, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m)
                visit(shell[m]);
        });
    }
}

/// O(voxels). The grid must have fewer than 2^32 voxels.
TaggedSurroundings taggedSurroundings(const Volume<std::uint8_t>& segmentation, int threads);

}  // namespace haustra::cleansing
