// The HU on which a lumen's surface is contoured where the scan does not give them as they are.
#pragma once

#include "core/result.h"
#include "core/volume.h"

#include <cstdint>

namespace haustra::contouring {

/// HU that rise from inside the lumen outwards, and the HU at which its wall stands.
struct WallField {
    Volume<std::int16_t> hu;
    double isoHu = 0.0;
    bool negated = false;  ///< against the scan: both signs are changed
};

/// A lumen with no scan: ±1000 outside and inside (label ≠ 0), smoothed over ±2 voxels with
/// binomial weights (sd 1 voxel), so that the surface at 0 lies between the same voxels as the
/// mask's boundary, but is no staircase. Beyond the grid is as its edge. Linear; takes the result
/// and 20 bytes a voxel of one slice for each thread. The same bytes for any number of threads.
WallField smoothedMask(const Volume<std::uint8_t>& labels, int threads = 0);

/// A lumen whose content has HU of its own: isoHu is midway between the medians of the lumen's
/// inner voxels and of the voxels two beyond its boundary, so where the half-filled voxel lies. All
/// signs are changed where the content is brighter than what surrounds it. Fails where the two
/// differ by less than 10 HU (noResult). Linear.
Result<WallField> contentField(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& labels,
                               int threads = 0);

}  // namespace haustra::contouring
