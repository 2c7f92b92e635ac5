// Fluid that clings to the wall at the level's rim.
#pragma once

#include "core/ct_scan.h"
#include "core/tissue.h"
#include "core/volume.h"

#include <cstdint>
#include <vector>

namespace haustra::cleansing {

/// Labels (LumenLabel), and the voxels, in memory order, that were none before.
struct LabelledMenisci {
    Volume<std::uint8_t> labels;
    std::vector<std::uint32_t> added;
};

/// `segmentation` (LumenLabel) with the menisci labelled as tagged: fluid climbs a wall by surface
/// tension, past the flat level where a segmentation by levels ends. Added are unlabelled voxels at
/// most 4.5 mm from a pool along the axes, with air of the lumen within 3 mm, along voxels that are
/// more than half as dense, from soft tissue on, as the pool's rim where they begin; and within 1.5
/// mm of any pool what the segmentation fell short of. Where voxels are large, 6, 4 and 2 of them.
/// O(voxels).
LabelledMenisci withMenisci(const CtScan& scan, const TissueModel& tissue,
                            const Volume<std::uint8_t>& segmentation);

}  // namespace haustra::cleansing
