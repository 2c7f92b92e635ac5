// Fluid that clings to the wall at the level's rim.
#pragma once

#include "core/ct_scan.h"
#include "core/tissue.h"
#include "core/volume.h"

#include <cstdint>
#include <vector>

namespace haustra::cleansing {

/// Labels (LumenLabel), and in memory order the voxels that were outside before.
struct LabelledMenisci {
    Volume<std::uint8_t> labels;
    std::vector<std::uint32_t> added;
};

/// `segmentation` (LumenLabel) with the menisci labelled as tagged: fluid climbs a wall by surface
/// tension, past the flat level where a segmentation by levels ends. A pool grows by steps along
/// the axes into unlabelled voxels above taggedAboveHu that are denser than half-way between soft
/// tissue and the pool's rim where the growth began: up to 4.5 mm far where air of the lumen lies
/// within 3 mm of the voxel, and up to 1.5 mm anywhere, as the segmentation may fall short by that.
/// It joins no two bodies of the lumen. Where voxels are large, the three lengths are 6, 4 and 2 of
/// them. O(voxels).
LabelledMenisci withMenisci(const CtScan& scan, const TissueModel& tissue,
                            const Volume<std::uint8_t>& segmentation);

}  // namespace haustra::cleansing
