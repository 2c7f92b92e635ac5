// Digital cleansing: the scan as it would be had the tagged residue in the colon been air.
#pragma once

#include "cleansing/tagged_lumen.h"
#include "core/boxed_volume.h"
#include "core/ct_scan.h"
#include "core/result.h"
#include "core/tissue.h"

#include <vector>

namespace haustra::cleansing {

struct Cleansed {
    /// Equals the scan but in and beside the tagged lumen, and where pseudo-enhancement was taken
    /// off.
    Volume<std::int16_t> hu;
    /// LumenLabel by the cleansed scan: the voxels below the model's airBelowHu that are in the
    /// segmentation or touch it. `tagged` where a voxel had held more residue than air.
    Volume<std::uint8_t> lumen;
};

/// Equation 3.3 of the dissertation and its counterpart for the enhanced mucosa:
/// y_new = y − m_tag μ_tag + m_tag μ_air, with the local mean of the tagging, on the scan
/// without pseudo-enhancement (pseudo_enhancement.h), where there is any. But for that only what
/// `segmentation` (LumenLabel) holds, and the partial volume around it, changes; fluid without
/// tagging goes by its label (untagged_fluid.h); a scan with neither comes back unchanged. The same
/// bytes for any number of threads.
Result<Cleansed> cleanse(const CtScan& scan, const TissueModel& tissue,
                         const Volume<TissueFractions>& mixture,
                         const Volume<std::uint8_t>& segmentation, int threads = 0);

/// A body of what the segmentation took for tagged, with more of its lumen all around it than the
/// blur reaches, that is wall once it is cleansed: fluid of too little contrast, or tissue.
struct LostLumen {
    glm::dvec3 placeMm{0.0};  ///< its middle
    double ml = 0.0;
};

/// The same with the lumen's box alone held.
struct CleansedLumen {
    BoxedVolume<std::int16_t> hu;
    BoxedVolume<std::uint8_t> lumen;
    /// 2 ml and more, the largest first: what covers a polyp, or a coated one, is less.
    std::vector<LostLumen> lost;
};

/// The same of what measureTaggedLumen has measured; beyond its box HU follow from the scan, whose
/// memory the result shares, as they are read. Takes some 4 bytes for each voxel of the box beside
/// `lumen`'s own.
CleansedLumen cleanse(const CtScan& scan, const TissueModel& tissue,
                      const Volume<TissueFractions>& mixture, TaggedLumen lumen, int threads = 0);

}  // namespace haustra::cleansing
