// The tagging's HU at each voxel, with the borders between differently tagged contents.
#pragma once

#include "cleansing/local_means.h"
#include "cleansing/tagged_surroundings.h"
#include "core/ct_scan.h"

namespace haustra::cleansing {

/// LocalMeans::taggedHu. Contents are even at a voxel that lies deeper in them than any blur
/// reaches and whose surroundings measure the same but for noise. There the result is the mean of
/// the even voxels around. Elsewhere it is the distance-weighted mean of the even contents whose
/// blur reaches the voxel, and `coarse` where there are none. Between two unlike even contents
/// (stool in fluid) it is the smoothed scan, which shows the blend of both; but not where that is
/// darker than both, as in a thin fold. Beside the labelled contents, what is denser than
/// `denseAboveHu` counts as contents too. Uses `means.softHu` and `means.noise`.
Volume<std::int16_t> refineTagging(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                                   const TaggedSurroundings& around, const SmoothField& coarse,
                                   const LocalMeans& means, double denseAboveHu, int threads);

}  // namespace haustra::cleansing
