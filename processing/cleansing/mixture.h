// Which tissues each voxel holds, and how much of each.
#pragma once

#include "core/ct_scan.h"
#include "core/parallel.h"
#include "core/result.h"
#include "core/tissue.h"

namespace haustra::cleansing {

struct MixtureOptions {
    int threads = 0;
    Progress progress;
};

/// The fractions of air, soft tissue (with fat) and tagged material or bone in each voxel: equation
/// 3.1 of the dissertation, y = Σ m_k μ_k + ε, estimated by EM with class means and variances
/// re-estimated from the scan (Wang et al. [131]), the tagged mean locally, and a spatial prior
/// that settles which pair of tissues a mixed voxel holds: HU alone cannot tell air–tagged from
/// soft tissue. `segmentation` (LumenLabel) tells which tagged material and air is bowel content;
/// `gravity` (unit LPS, zero where unknown) points down. The same bytes for any number of threads.
Result<Volume<TissueFractions>> estimateMixture(const CtScan& scan, const TissueModel& tissue,
                                                const Volume<std::uint8_t>& segmentation,
                                                glm::dvec3 gravity,
                                                const MixtureOptions& options = {});

}  // namespace haustra::cleansing
