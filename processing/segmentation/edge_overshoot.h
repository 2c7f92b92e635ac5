// What a sharp reconstruction kernel adds to the wall beside gas.
#pragma once

#include "core/tissue.h"
#include "segmentation/bowel_contents.h"

namespace haustra::segmentation {

/// The HU that the wall's overshoot beside gas stays below: the median of the wall's peaks and two
/// and a half standard deviations, and as much over soft tissue once more, since in a fold, which
/// has gas on both sides, two rims add up. 0 where no more than a twentieth of the wall is brighter
/// than what counts as tagged. Peaks are sought within 2 mm of gas, but in two voxels at least, as
/// the first of wide ones has the edge's own blur.
///
/// A kernel that lifts high frequencies (lung, bone) makes a bright rim of one or two millimetres
/// all around gas. Fluid does not hang from ceilings, and films coat a hundredth of them: of four
/// sides of the gas, left, right, front and back, the one with the least bright wall tells, as
/// which of them is up is not known yet. O(voxels).
double overshootBesideGasHu(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& content,
                            const TissueModel& tissue, int threads);

/// Takes for tissue what looks tagged, is no brighter than overshootBesideGasHu and lies within 2.5
/// mm of gas, but not under a level, where it is fluid; a note says so. Nothing where there is no
/// overshoot.
void takeOffOvershoot(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                      BowelContents& contents, int threads);

}  // namespace haustra::segmentation
