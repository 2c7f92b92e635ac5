// How far a patch stands above the wall around it, continued across it.
#pragma once

#include "cad/lesion.h"
#include "cad/wall_evidence.h"

namespace haustra::cad {

/// Above the quadric that fits the wall around the patch best (wall_quadric.h; z along the patch's
/// mean normal), so with the wall's own curvature. A lesion's base, a soap film, has no mean
/// curvature: across a tube of radius r a film d wide lies up to d²/16r above the wall, which is
/// half of a flat lesion's height; and beneath a patch that is only the middle of a lesion it lies
/// close to the patch.
struct WallLift {
    double meanMm = 0.0;  ///< of the patch, by area; lumenward
    double topMm = 0.0;   ///< a tenth of its samples is higher
    /// Mean distance of the wall around from the quadric, along z, each at most 3 mm.
    double roughMm = 0.0;
};

/// All 0 where too little wall around was seen and faces as the patch does. `numbers`: of all
/// samples, for its own use. O(samples within 7 mm of the patch).
WallLift liftOf(const WallEvidence& evidence, const Patch& patch, SampleNumbers& numbers);

}  // namespace haustra::cad
