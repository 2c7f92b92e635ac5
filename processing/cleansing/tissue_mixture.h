// Which HU mean air, fat, soft tissue and tagged material or bone in this scan.
#pragma once

#include "core/ct_scan.h"
#include "core/result.h"
#include "core/tissue.h"

namespace haustra::cleansing {

/// Fits a Gaussian mixture to the scan's histogram by EM (dissertation §3.2; first form, on whole
/// voxels), its means within `priors`. Fails where the scan holds no air or no soft tissue.
Result<TissueModel> fitTissueModel(const CtScan& scan, int threads = 0,
                                   const TissuePriors& priors = {});

}  // namespace haustra::cleansing
