// Which tissues each voxel holds, and how much of each.
#pragma once

#include "cleansing/partial_volume_em.h"
#include "cleansing/tagged_lumen.h"
#include "core/boxed_volume.h"
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
/// 3.1 of the dissertation, y = Σ m_k μ_k + ε (Wang et al. [131]). Away from the tagged lumen they
/// are what EM over tissues and pairs of tissues expects of the voxel's HU, with class means and
/// variances re-estimated from the scan (partial_volume_em.h). In and around the tagged lumen they
/// solve the equation for the means measured nearby (local_means.h); which tissues a mixed voxel
/// holds, which HU alone cannot tell, is settled by the length of the step through it
/// (interface_layer.h), the water level (water_level.h), the profile of thin films (thin_films.h)
/// and the wall's course (level_rim.h).
/// What tagging adds to its surroundings by beam hardening is taken off before
/// (pseudo_enhancement.h). `segmentation` (LumenLabel) tells which tagged material and air is bowel
/// content; `gravity` (unit LPS, zero where unknown) points down. The same bytes for any number of
/// threads.
Result<Volume<TissueFractions>> estimateMixture(const CtScan& scan, const TissueModel& tissue,
                                                const Volume<std::uint8_t>& segmentation,
                                                glm::dvec3 gravity,
                                                const MixtureOptions& options = {});

/// The fractions by HU alone.
Volume<TissueFractions> fractionsByHu(const Volume<std::int16_t>& hu,
                                      const PartialVolumeModel& model, int threads);

/// estimateMixture in its steps, each with no more in memory than it needs: `model` of the scan,
/// the fractions `byHu` of its LumenPart, and what was measured of that; `lumen` is null where
/// there is no tagging. Held is the lumen's box: beyond it fractions follow from the scan, whose
/// memory the result shares, as they are read. Takes some 2 bytes for each voxel of the box beside
/// `byHu`.
BoxedVolume<TissueFractions> estimateMixture(const CtScan& scan, const PartialVolumeModel& model,
                                             Volume<TissueFractions> byHu, const TaggedLumen* lumen,
                                             glm::dvec3 gravity,
                                             const MixtureOptions& options = {});

}  // namespace haustra::cleansing
