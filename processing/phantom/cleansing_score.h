// How near a cleansed scan comes to the same scan with air in place of the tagging.
#pragma once

#include "core/result.h"
#include "phantom/phantom.h"

#include <vector>

namespace haustra::phantom {

/// Where a region is worst: a cube of about a centimetre.
struct WorstPlace {
    glm::ivec3 voxel{0};  ///< the voxel of the largest error within the cube
    std::size_t voxels = 0;
    double rmseHu = 0.0, biasHu = 0.0;
};

/// Error of the cleansed HU against the untagged truth over a region.
struct RegionError {
    std::size_t voxels = 0;
    double rmseHu = 0.0;
    double biasHu = 0.0;  ///< mean of cleansed − truth
    double maxHu = 0.0;   ///< of the absolute error
    /// The cubes with the largest sums of squared errors, worst first; at most worstPlaces.
    std::vector<WorstPlace> worst;
};

/// What became of one polyp that tagged fluid surrounds.
struct SubmergedPolyp {
    Finding polyp;
    double submergedShare = 0.0;  ///< the tagged share of the lumen within two voxels of the polyp
    std::size_t voxels = 0;       ///< of its tissue inward of the wall or fold it grows from
    double rmseHu = 0.0, biasHu = 0.0;  ///< in those voxels
    /// Of its voxels that are denser than polypHu in the truth, the share that is so after
    /// cleansing.
    double volumeShare = 0.0;
    /// Voxels of lumen around it that only after cleansing are denser than polypHu, as a share of
    /// its own.
    double excessShare = 0.0;
};

struct CleansingScore {
    // The tagged lumen and its surroundings. `fluid`: only tagged lumen within two voxels along
    // each axis. `interface`: air and tagged lumen both within two voxels. `wall`: tagged lumen and
    // what is not lumen both within two voxels. `rim`: all three, as where the waterline meets the
    // wall; part of `interface` and of `wall`.
    RegionError fluid, interface, wall, rim;
    /// Beyond four voxels from tagged lumen nothing should change.
    std::size_t voxelsChangedBeyond = 0;
    double maxChangeBeyondHu = 0.0;
    std::vector<SubmergedPolyp> polyps;  ///< more than half submerged, in the phantom's order
};

inline constexpr double polypHu = -400.0;
inline constexpr std::size_t worstPlaces = 8;

/// Scores `cleansedHu` by truth.untaggedHu, which has the same noise. Regions are those of the true
/// labels, wherever the cleansing sought the tagging. Fails where the grids differ, or the truth's
/// volumes do not lie on one. Linear; holds 2 bytes a voxel. One thread.
Result<CleansingScore> scoreCleansing(const Phantom& truth, const Volume<std::int16_t>& cleansedHu);

}  // namespace haustra::phantom
