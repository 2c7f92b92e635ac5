// How much of each voxel under the level is tagged: the likeliest shares of all voxels together.
#pragma once

#include "cleansing/local_means.h"
#include "cleansing/point_spread.h"
#include "cleansing/tagged_surroundings.h"
#include "core/ct_scan.h"
#include "core/tissue.h"

namespace haustra::cleansing {

/// How surely a voxel lies in tissue that is thin or small beside it, 0…1: the largest eigenvalue
/// of the Hessian, by differences over a neighbour step, is that of a dark sheet (a fold: one
/// large) or a dark cap or ball (a polyp: two or three) in bright contents, beyond what noise of
/// `noiseSd` HU makes (structure-analysis cleansing: Cai et al., Med. Phys. 2008; 35: 3259). 0 at
/// the grid's border.
double structureSignature(const Volume<std::int16_t>& hu, glm::ivec3 voxel, double noiseSd);

/// Settles in `mixture` the shares t of tagging where gas' blur does not reach and the contents are
/// not pure: the maximum a posteriori of dissertation equations 3.1 and 3.2 with a Gauss–Markov
/// field as prior, Σ (y − μ_soft − t (μ_tag − μ_soft))² / 2σ² + β Σ w (t − t')² / 2 over neighbours
/// along the axes, with the local means and w = exp(−d²/2) at the distance d in standard deviations
/// of the blur. Where the tagging is dense the scan decides; where it is weak, and taking it out
/// would amplify the noise by the contrast of air, y is that of a quadratic fitted to the voxels
/// around, and the prior does more. Folds and polyps by their bend (structureSignature) are left
/// to the scan. Tagging that no label holds counts where it is no noise. Six sweeps of simultaneous
/// minimisation; the same for any number of threads.
void settleSubmerged(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                     const LocalMeans& means, const PointSpread& spread,
                     const TaggedSurroundings& around, Volume<TissueFractions>& mixture,
                     int threads);

}  // namespace haustra::cleansing
