// The tagging's HU at each voxel, with the borders between differently tagged contents.
#pragma once

#include "cleansing/local_means.h"
#include "cleansing/tagged_surroundings.h"
#include "core/ct_scan.h"

namespace haustra::cleansing {

/// LocalMeans::taggedHu. Inside even contents it is the mean of the like voxels around; beside a
/// border the distance-weighted mean of the even contents that the blur reaches from, else
/// `coarse`. Between two unlike contents (stool in fluid) it is what the scan shows, smoothed: the
/// blend of both. A thin fold in fluid is not taken for a blend: nothing even in it is as dark.
/// What is denser than `denseAboveHu` counts as contents beside them. Uses `means.softHu` and
/// `means.noise`.
Volume<std::int16_t> refineTagging(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                                   const TaggedSurroundings& around, const SmoothField& coarse,
                                   const LocalMeans& means, double denseAboveHu, int threads);

}  // namespace haustra::cleansing
