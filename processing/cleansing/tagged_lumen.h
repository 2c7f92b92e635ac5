// The tagged lumen of a scan, and all that mixture and cleansing measure of it alike.
#pragma once

#include "cleansing/local_means.h"
#include "cleansing/pseudo_enhancement.h"
#include "cleansing/tagged_surroundings.h"
#include "core/crop.h"
#include "core/ct_scan.h"
#include "core/result.h"
#include "core/tissue.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace haustra::cleansing {

/// The box of a scan that has all labels (LumenLabel) and what is within 20 mm of them. What is
/// sampled, or measured in cells, is so by the box's voxels, which begin a fixed way before the
/// labels: the same colon elsewhere in a scan is measured alike.
struct LumenPart {
    Grid scanGrid;
    VoxelBox box;
    CtScan scan;
    Volume<std::uint8_t> labels;
};

/// None where nothing is labelled tagged. Fails where `scan` and `segmentation` are on different
/// grids (badInput), or the box has 2^32 voxels (unsupported).
Result<std::optional<LumenPart>> cropToLumen(const CtScan& scan,
                                             const Volume<std::uint8_t>& segmentation, int threads);

/// Volumes, indices and `means` are the box's.
struct TaggedLumen {
    Grid scanGrid;
    VoxelBox box;
    CtScan scan;                         ///< less pseudo-enhancement
    Volume<std::uint8_t> labels;         ///< with menisci (menisci.h)
    std::vector<std::uint32_t> menisci;  ///< voxels that menisci added, in memory order
    PseudoEnhancement enhancement;       ///< on the scan's grid
    TaggedSurroundings around;
    LocalMeans means;
};

/// O(voxels of the box); the same for any number of threads.
TaggedLumen measureTaggedLumen(LumenPart part, const TissueModel& tissue, int threads);

}  // namespace haustra::cleansing
