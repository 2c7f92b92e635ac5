// Class means, variances and fractions from the scan's histogram, partial volume counted in.
#pragma once

#include "cleansing/hu_histogram.h"
#include "core/ct_scan.h"
#include "core/tissue.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace haustra::cleansing {

/// The tissue classes and what a voxel of a given HU most likely holds where nothing but its HU is
/// known: far from the colon.
struct PartialVolumeModel {
    TissueModel tissue;
    std::vector<TissueFractions> fractions;  ///< by HU, from lowestHu on

    TissueFractions fractionsOf(int hu) const {
        return fractions[std::size_t(std::clamp(hu, lowestHu, highestHu) - lowestHu)];
    }
};

/// Equations 3.1 and 3.2 of the dissertation on the scan's histogram. Each voxel is one tissue, or
/// two that touch (air–fat, air–soft, fat–soft, soft–tagged) in any shares m and 1 − m, all equally
/// likely: its HU then has mean Σ m_k μ_k and variance Σ m_k σ_k². EM over tissues, pairs and
/// shares, with the conditional means and variances of the unobserved x_k in the M step, so mixed
/// voxels widen no class. The expected shares by HU are the fractions. About 0.1 s after one pass
/// over the scan. The same for any number of threads.
PartialVolumeModel fitPartialVolume(const CtScan& scan, const TissueModel& start, int threads);

}  // namespace haustra::cleansing
