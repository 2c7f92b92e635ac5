// The lumen of an organ whose content has HU of its own: contrast-filled vessels, a bladder.
#pragma once

#include "core/ct_scan.h"
#include "core/parallel.h"
#include "core/result.h"
#include "core/tissue.h"

#include <string>
#include <vector>

namespace haustra::segmentation {

struct HuRangeOptions {
    HuRange contentHu;       ///< voxels of these HU are content
    double openingMm = 0.0;  ///< what no ball of this radius fits into is cut off; 0: nothing
    std::vector<glm::dvec3> seedsMm;     ///< the bodies of content at these points (patient, LPS)
    std::vector<glm::dvec3> excludesMm;  ///< the bodies at these points are not the organ
    int threads = 0;
    Progress progress;
};

struct HuRangeLumen {
    Volume<std::uint8_t> labels;  ///< LumenLabel: outside, or air, which stands for the content
    int bodies = 0;               ///< connected bodies of content that were taken
    std::vector<std::string> notes;
};

/// The 6-connected bodies of content at the seeds or, without a seed, the largest one; what they
/// enclose (stones, noise) belongs to them. Morphological opening, where asked for, comes
/// before connection, so that a thin bridge to other content of the same HU is cut.
///
/// Fails where nothing has such HU (noResult), a point is off the scan or more than 5 mm from any
/// such voxel, or the voxel axes are not at right angles and there is an opening (badInput). Linear
/// in the voxels; takes 2 bytes a voxel beside the result, 4 more with an opening. The same bytes
/// for any number of threads.
Result<HuRangeLumen> findHuRangeLumen(const Volume<std::int16_t>& hu,
                                      const HuRangeOptions& options);

/// HU smoothed against noise by binomial weights to about `sdMm` along each axis, in whole steps of
/// a voxel; a flat wall's half-way HU stays where it is. Linear.
Volume<std::int16_t> smoothHu(const Volume<std::int16_t>& hu, double sdMm, int threads = 0);

/// Grows the labels through voxels on the content's side of `isoHu` (above it where the content is
/// brighter than what surrounds it), by at most three voxels (6-connected): from where the content
/// is sure to where its wall stands. Fills what that encloses. `labels` must own its memory and be
/// on the grid of `hu`.
void growToWall(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu, double isoHu,
                bool contentBrighter, int threads = 0);

}  // namespace haustra::segmentation
