// Balls of voxels around a voxel.
#pragma once

#include "core/grid.h"

#include <vector>

namespace haustra::cleansing {

/// Farther than this from a border the scanner's blur does not reach, mm.
inline constexpr double blurReachMm = 1.6;

/// Offsets of the voxels within `radiusMm` but the centre, always with the six face neighbours;
/// the farthest first, as they are the likeliest to differ from it.
std::vector<glm::ivec3> ballOffsets(const Grid& grid, double radiusMm);

/// Whether `holds(index)` at every voxel of the ball that is within the grid.
template <class Predicate>
bool everywhere(const Grid& grid, const std::vector<glm::ivec3>& offsets, glm::ivec3 v,
                const Predicate& holds) {
    for (const glm::ivec3 d : offsets) {
        const glm::ivec3 n = v + d;
        if (grid.contains(n) && !holds(grid.index(n))) return false;
    }
    return true;
}

}  // namespace haustra::cleansing
