// The bodies of tagged fluid that stand under air.
#pragma once

#include "core/tissue.h"
#include "core/volume.h"
#include "topology/air_fluid.h"

#include <cstdint>
#include <vector>

namespace haustra::topology {

/// A body of tagged material: its voxels' indices, sorted.
struct Pool {
    std::vector<std::uint32_t> voxels;
    std::vector<int> levels;   ///< indices of the levels that stand on it
    std::vector<int> touches;  ///< earlier pools that are one body of fluid with this one
    double meanHu = 0.0;
};

/// The fluid under each level, levels of one body of fluid together. Grown through voxels well
/// inside the fluid's HU, so that the thin wall to the next bowel loop stops it; then out to the
/// half-way HU. Never above the level it belongs to. A pool that wide parts of lie beside its level
/// is grown again through voxels with fluid all around, which no pinhole in a wall lets pass, and
/// is that one if it is much smaller; where little lies straight under the level even then, only
/// that is kept. Linear in the voxels of the fluid; one thread.
std::vector<Pool> floodPools(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                             const std::vector<Level>& levels, GravityAxis down);

}  // namespace haustra::topology
