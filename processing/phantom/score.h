// How near a lumen and a centerline that were found come to the truth.
#pragma once

#include "core/centerline.h"
#include "core/ct_scan.h"
#include "core/result.h"

namespace haustra::phantom {

struct LumenScore {
    /// 2 |A ∩ B| / (|A| + |B|), 1 where both are empty: of the whole lumen (air and tagged
    /// together), and of each label alone.
    double dice = 0.0;
    double diceAir = 0.0;
    double diceTagged = 0.0;
    /// Found, but not lumen: all of it, and what lies more than `falseBeyondMm` from any lumen.
    /// The first holds the half-voxel disagreement along the whole wall; the second is other
    /// organs, and is what the project calls false volume.
    double overMl = 0.0;
    double falseMl = 0.0;
    double missedMl = 0.0;  ///< lumen that was not found
    /// Length of the true centerline (gaps aside) that runs through voxels found to be outside, and
    /// its share of that centerline's length.
    double missedCenterlineMm = 0.0;
    double missedCenterlineShare = 0.0;
    /// Distances from the found centerline's samples (gaps aside) to the true one, as a polyline;
    /// 0 where nothing was found.
    double centerlineMeanErrorMm = 0.0;
    double centerlineMaxErrorMm = 0.0;
};

inline constexpr double falseBeyondMm = 3.0;

/// Labels are LumenLabel; any other value than 0 counts as lumen. Fails where the grids differ.
/// O(voxels + samples of one centerline × samples of the other).
Result<LumenScore> scoreLumen(const Volume<std::uint8_t>& truthLabels,
                              const Centerline& truthCenterline,
                              const Volume<std::uint8_t>& foundLabels,
                              const Centerline& foundCenterline);

}  // namespace haustra::phantom
