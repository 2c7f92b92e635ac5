// The fluid beneath levels that took no tagging, as far as it can be told from the wall.
#pragma once

#include "core/tissue.h"
#include "segmentation/bowel_contents.h"
#include "segmentation/untagged_levels.h"

#include <vector>

namespace haustra::segmentation {

/// Marks as Content::untagged what stands beneath these levels (findUntaggedLevels): tissue below
/// the level whose HU, smoothed to 1.5 mm, are nearer to the fluid's than to soft tissue's or to
/// fat's, opened by a ball and connected with the level. Fluid that took a little tagging is
/// brighter than soft tissue: then they are nearer to its HU than to soft tissue's, and at most 60
/// over it. What rises slowly from there to flat tagging is the fluid's, too. The outermost
/// millimetre that balls reach is the wall's: a distended colon's wall is 1 to 2 mm thick (Wiesner
/// et al., J Comput Assist Tomogr 2002; 26: 102), too thin to show its own HU between fluid and
/// fat.
///
/// Gas below a level is another lumen's, or a bubble with its own level. Fluid stands no higher
/// than its level: what rises over it has leaked into what only looks like fluid, or through a thin
/// wall into a bladder. Then larger balls are tried (3 to 8 mm), and where none holds, the level
/// stays without a pool. A lumen whose roof lies below the level is full, and a part of the pool.
/// What is bright beneath is sediment where it lies flat, else bone, and the pool ends 2.5 mm over
/// it. Returns whether any level has one.
///
/// `contents` must own its memory and have its gravity. O(voxels around levels); the same for any
/// number of threads.
bool markUntaggedPools(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                       const std::vector<UntaggedLevel>& levels, BowelContents& contents,
                       int threads);

}  // namespace haustra::segmentation
