// How high a lesion stands: what a reader is told.
#pragma once

#include "cad/lesion.h"
#include "cad/wall_evidence.h"

namespace haustra::cad {

/// In mm above the wall as it would be without the lesion, a stalk included: the wall beyond the
/// lesion's foot, continued across it by the quadric that fits best (wall_quadric.h); of what
/// stands on a stalk and has a foot, the way from the foot's middle to the place farthest from it.
/// Not more than above the lesion's base, a soap film, where that wall is a fold, and hardly more
/// where folds are near; above that film where nobody has seen enough of the wall. Not negative.
/// `numbers`: of all samples, for its own use. O(samples within 28 mm of the patch).
double standingHeightMm(const WallEvidence& evidence, const Lesion& lesion, SampleNumbers& numbers);

}  // namespace haustra::cad
