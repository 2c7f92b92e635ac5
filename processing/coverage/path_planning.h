// Camera places that leave few blind areas (dissertation §1.2.1, §7.2.7).
#pragma once

#include "coverage/missed_review.h"

namespace haustra::coverage {

/// What a planned path may be made of.
struct PlanOptions {
    double stepMm = 10.0;  ///< between the places of the centerline that candidates stand at
    int trialSide = 256;   ///< pixels of a candidate's picture
    int threads = 0;
    Progress progress = {};
    std::function<bool()> cancelled = {};
};

/// At most `count` cameras that show as much of the wall's area as can be: "a planned path should
/// not produce significant blind areas on the colon surface" (§1.2.1), which the centerline does
/// where it bends (§7.2.7). Candidates stand at each step on the centerline and, in six directions
/// across it, at six tenths of the way to the wall (at most 25 mm), and look both ways along it,
/// those beside it towards the centerline's place 20 mm on. Of them, greedily, the one that shows
/// most area that no other shows yet, of two the earlier (Nemhauser et al., Math. Programming
/// 1978;14:265: at least 63 % of what the best choice of so many shows). When they show no more,
/// cameras turned to the patches that are left (cameraForPatch), the largest first. In the order of
/// the centerline. Deterministic. Some 8 ms for each of 14 candidates a step, and 50 kB. Fails as
/// look() does, and (noResult) without a centerline.
Result<std::vector<CenterlineCamera>> plannedCameras(const SightTree& tree,
                                                     const CoverageWall& wall,
                                                     const PinholePicture& picture, int count,
                                                     const PlanOptions& options = {});

}  // namespace haustra::coverage
