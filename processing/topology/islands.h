// Islands of background that float in a lumen: tied to the wall, or filled.
#pragma once

#include "core/volume.h"
#include "topology/bit_mask.h"

#include <string>
#include <vector>

namespace haustra::topology {

/// An island of so much is worth tying and worth a note: a ball of 4.6 mm.
inline constexpr double leastIslandMm3 = 50.0;
/// No stalk is longer.
inline constexpr double longestStalkMm = 25.0;

/// The scan that a lumen was found in; where it shows a trace of a stalk, the stalk is laid.
struct StalkTraces {
    const Volume<std::int16_t>* hu = nullptr;  ///< null: the shortest way is taken
    glm::ivec3 from{0};                        ///< the scan's voxel that is the mask's (0, 0, 0)
    double gasHu = -1000.0, wallHu = -500.0;   ///< no trace, all of a wall
};

struct Islands {
    long tied = 0, filled = 0;
    std::vector<std::string> notes;
};

/// Tissue hangs on something. The 18-connected components of the background that the mask encloses
/// are heads of polyps whose stalk is thinner than the scan resolves, or residue. Each from
/// leastIslandMm3 on, the largest first, is tied to the wall, or to an island that is tied: along
/// the cheapest 6-connected way through the mask, at most longestStalkMm long, its voxels are
/// cleared. A millimetre costs 1 / (1 + 10 w), w the share of wall that the scan shows there (0 in
/// gas). Voxels of `kept` stay. All other islands are filled. Each that is tied, and each filled
/// one of that size, has a note. O(voxels of the mask · log).
Islands tieOrFillIslands(BitMask& mask, const BitMask& kept, const Grid& grid,
                         const StalkTraces& traces = {});

}  // namespace haustra::topology
