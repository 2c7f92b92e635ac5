// Tagged fluid that clings to a wall in a film about as thin as the scanner's blur.
#pragma once

#include "cleansing/local_means.h"
#include "cleansing/point_spread.h"
#include "cleansing/tagged_surroundings.h"
#include "core/ct_scan.h"
#include "core/tissue.h"

namespace haustra::cleansing {

/// Settles in `mixture` the shares of films of tagging between wall and air. Such a film never
/// shows its own HU and its two faces share voxels, so that no pair of tissues explains them.
/// Across each crest (a voxel that is brightest across the film) a profile (film_profile.h) is
/// fitted to the scan. What the fitted film adds to a voxel's HU is tagging; what the profile does
/// not explain remains in the cleansed scan. Only voxels that the air's blur reaches are settled:
/// other voxels of the wall hold two tissues at most. Beside a pool, whose edge runs out in a
/// wedge, only a film with parallel faces and the pool's HU counts. `segmentation` is LumenLabel.
/// Returns 1 for the voxels settled, else 0. The same for any number of threads.
Volume<std::uint8_t> settleFilms(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                                 const LocalMeans& means, const PointSpread& spread,
                                 const TaggedSurroundings& around, Volume<TissueFractions>& mixture,
                                 int threads);

}  // namespace haustra::cleansing
