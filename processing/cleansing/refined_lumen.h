// The lumen as the cleansed scan shows it.
#pragma once

#include "cleansing/smooth_field.h"
#include "core/ct_scan.h"
#include "core/tissue.h"
#include "core/volume.h"

#include <cstdint>
#include <span>
#include <vector>

namespace haustra::cleansing {

/// One voxel that cleansing changed.
struct CleansedVoxel {
    std::uint32_t index;
    std::uint8_t tagged;  ///< share of residue taken out, in 255ths
    std::uint8_t air;     ///< share of air it held before, in 255ths
};

/// LumenLabel by the cleansed scan: what `segmentation` holds, less what is wall now, and more by
/// those of `changed` (in memory order) that are air now and touch it, unless they join what is
/// parted there: a thin wall that the blur of tagging hides stays. Specks of less than 12 mm³
/// that float in the former residue are noise: they become air in `hu`, and lumen. Bridges and
/// untagged fluid stay.
Volume<std::uint8_t> refineLumen(Volume<std::int16_t>& hu, const TissueModel& tissue,
                                 const SmoothField& airHu, const Volume<std::uint8_t>& segmentation,
                                 std::span<const CleansedVoxel> changed);

}  // namespace haustra::cleansing
