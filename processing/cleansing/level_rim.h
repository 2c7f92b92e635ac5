// The rim of a fluid level, where air, fluid and wall share voxels.
#pragma once

#include "cleansing/local_means.h"
#include "cleansing/point_spread.h"
#include "cleansing/tagged_surroundings.h"
#include "cleansing/water_level.h"
#include "core/ct_scan.h"
#include "core/tissue.h"

namespace haustra::cleansing {

/// Settles the shares of residue in `mixture` within 2.5 standard deviations of the blur of the
/// fluid's level, beside walls. One HU cannot tell the shares of three tissues, but the wall goes
/// on straight past the level: above and below, beyond the reach of the level's blur, it is known.
/// Along the wall's direction (the one in which the cleansed scan changes least there) the cleansed
/// HU is interpolated, and the share of residue is the one that explains the difference between
/// that HU and the scan's. Where the wall bends too much for that, a voxel that juts out of it
/// where air and tagging meet is made like its neighbours. `segmentation` is LumenLabel; voxels
/// that are 1 in `settled` stay. The same for any number of threads.
void settleRim(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
               const LocalMeans& means, const WaterLevel& level, const PointSpread& spread,
               const TaggedSurroundings& around, const Volume<std::uint8_t>& settled,
               Volume<TissueFractions>& mixture, int threads);

}  // namespace haustra::cleansing
