// The stages that read the scan: import, segmentation, mixture, cleansing.
#pragma once

#include "cleansing/tagged_lumen.h"
#include "pipeline/preparation.h"

#include <optional>

namespace haustra::pipeline {

using store::ProductKey;

/// Each runs its stage and returns its products' key; the arguments are the keys of what it reads.
Result<ProductKey> importScan(Preparation& preparation);
/// `segmentation` as the organ's profile finds it in the scan.
Result<ProductKey> segmentScan(Preparation& preparation, const ProductKey& ct);
/// `segmentation` from --lumen; without a scan the mask stands alone.
Result<ProductKey> takeMask(Preparation& preparation, const std::optional<ProductKey>& ct);
/// What it measures of the tagged lumen it leaves in `lumen`, so that cleansing need not measure it
/// again.
Result<ProductKey> mixTissues(Preparation& preparation, const ProductKey& ct,
                              const ProductKey& segmentation,
                              std::optional<cleansing::TaggedLumen>& lumen);
/// `cleansed-lumen` and `cleansed`.
Result<ProductKey> cleanseScan(Preparation& preparation, const ProductKey& ct,
                               const ProductKey& segmentation, const ProductKey& mixture,
                               std::optional<cleansing::TaggedLumen> lumen);

}  // namespace haustra::pipeline
