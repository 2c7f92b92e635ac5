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

/// Held is the box of the scan that has all labels and what is within 20 mm of them; volumes,
/// indices and `means` are the box's.
struct TaggedLumen {
    Grid scanGrid;
    VoxelBox box;
    CtScan scan;                         ///< less pseudo-enhancement
    Volume<std::uint8_t> labels;         ///< LumenLabel, with menisci (menisci.h)
    std::vector<std::uint32_t> menisci;  ///< voxels that the segmentation has not, in memory order
    PseudoEnhancement enhancement;       ///< on the scan's grid
    TaggedSurroundings around;
    LocalMeans means;
};

/// None where nothing is labelled tagged. What is measured is the same as of the whole scan. Fails
/// where `scan` and `segmentation` (LumenLabel) are on different grids (badInput), or the box has
/// 2^32 voxels (unsupported). O(voxels of the box); the same for any number of threads.
Result<std::optional<TaggedLumen>> findTaggedLumen(const CtScan& scan, const TissueModel& tissue,
                                                   const Volume<std::uint8_t>& segmentation,
                                                   int threads);

}  // namespace haustra::cleansing
