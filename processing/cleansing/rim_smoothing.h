// The wall's shape where air, residue and wall met.
#pragma once

#include "cleansing/tagged_surroundings.h"
#include "core/ct_scan.h"
#include "core/tissue.h"
#include "core/volume.h"

#include <cstdint>
#include <vector>

namespace haustra::cleansing {

/// Smooths the cleansed scan along the line where air, tagging and wall met. One HU cannot tell the
/// shares of three tissues, so that taking the tagging out leaves creases, dashes and flecks there,
/// a voxel or two wide. They are smoothed away: the level surfaces of the HU move by their mean
/// curvature, ∂f/∂t = κ |∇f| (Osher and Sethian 1988), for t = 0.5 mm², which flattens what is
/// narrower than 2 mm. Only voxels near that line change, and of these only where the HU are rough
/// and 1.5 mm around. A ball of radius r mm that crosses the line loses at most 1/r mm there; a
/// thin flat sheet has no curvature and stays. `labels` (LumenLabel) says what was air before
/// cleansing, `around` where the tagging's blur reaches. Returns the changed voxels, in memory
/// order. O(surroundings); the same for any number of threads.
std::vector<std::uint32_t> smoothRim(Volume<std::int16_t>& hu, const Volume<std::uint8_t>& labels,
                                     const TissueModel& tissue, const TaggedSurroundings& around,
                                     int threads);

}  // namespace haustra::cleansing
