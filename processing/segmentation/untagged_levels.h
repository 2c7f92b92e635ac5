// Levels of fluid that took no tagging: flat ends of the gas over something of soft tissue's HU.
#pragma once

#include "core/tissue.h"
#include "core/volume.h"
#include "segmentation/air_fluid_levels.h"

#include <optional>
#include <vector>

namespace haustra::segmentation {

struct UntaggedLevel {
    glm::dvec3 placeMm{0.0};  ///< patient, LPS: the middle of the surface
    double areaMm2 = 0.0;
    double fluidHu = 0.0;   ///< median, 1.5 to 6 mm beneath
    double heightMm = 0.0;  ///< along the gravity axis, downwards, from voxel 0
    /// Its HU rise with the depth until they are the tagging's: what is heavier sank.
    bool graded = false;
    bool likeWall = false;            ///< its HU are soft tissue's
    std::vector<glm::ivec3> columns;  ///< the last voxel of gas of each
};

/// Where HU along the level (meanAlongLevel) first are the tagging's, for two voxels, in steps from
/// a voxel downwards, on a way that rises but for noise, and no farther than the longest gradient.
/// Empty where there is no such.
std::optional<double> stepsToTagged(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                                    glm::ivec3 from, GravityAxis down);

/// Where the labelled gas ends downwards in a plane, over what is neither tagged nor of soft
/// tissue's own HU, or over what rises slowly to the tagging's, whatever HU it begins with: from a
/// wall to bone or another bowel's tagging behind it HU rise at once. Fluid at rest is flat to a
/// fraction of a voxel and ends at a wall; a lumen's floor goes on rising gently beside its lowest
/// line: of radius r, up to a slope of 0.6, three fifths of its width lie 0.3 mm off any one height
/// where r is 10 mm or more. So of columns that follow each other with such slopes, three fifths,
/// and 100 mm², have to share a height; or, where a shore goes on from a level, seven eighths or so
/// of a disc of 9 mm in radius, which is flat beneath a lumen of more than 65 mm only. `labels` are
/// LumenLabel on the grid of `hu`. The largest first; the same for any number of threads.
/// O(voxels).
std::vector<UntaggedLevel> findUntaggedLevels(const Volume<std::int16_t>& hu,
                                              const TissueModel& tissue,
                                              const Volume<std::uint8_t>& labels, GravityAxis down,
                                              int threads);

}  // namespace haustra::segmentation
