// Air–fluid levels: where tagged fluid stands under air, and which fluid that is.
#pragma once

#include "core/tissue.h"
#include "core/volume.h"
#include "topology/run_components.h"

#include <cstdint>
#include <vector>

namespace haustra::topology {

/// Down, as the grid sees it: an axis (0 or 1) and a sign.
struct GravityAxis {
    int axis = 1;
    int sign = 1;
};

/// One column of a level: air ends above `above`, fluid begins at `below` (voxel coordinates along
/// the gravity axis), with up to a few partial-volume voxels in between.
struct LevelColumn {
    glm::ivec3 above, below;
    std::int32_t air;  ///< component of the air
};

/// A flat patch of columns at one height.
struct Level {
    std::vector<LevelColumn> columns;
    double areaMm2 = 0.0;
    int height = 0;        ///< voxel coordinate of the fluid's surface along the gravity axis
    double fluidHu = 0.0;  ///< median HU just below the surface
};

/// Flat levels for one direction of gravity (dissertation §3.2: below their air and above their
/// fluid). Only air whose entry in `bowelAir` is set counts.
std::vector<Level> findLevels(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                              const RunComponents& air, const std::vector<char>& bowelAir,
                              GravityAxis down, int threads);

/// Total area of levels, mm²: how a direction of gravity shows in the data.
double totalAreaMm2(const std::vector<Level>& levels);

/// A body of tagged material: its voxels' indices, sorted.
struct Pool {
    std::vector<std::uint32_t> voxels;
    std::vector<int> levels;   ///< indices of the levels that stand on it
    std::vector<int> touches;  ///< earlier pools that are one body of fluid with this one
    double meanHu = 0.0;
};

/// The fluid under each level, levels of one body of fluid together. Grown through voxels well
/// inside the fluid's HU, so that the thin wall to the next bowel loop stops it; then out to the
/// half-way HU. Never above the highest level it belongs to.
std::vector<Pool> floodPools(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                             const std::vector<Level>& levels, GravityAxis down);

}  // namespace haustra::topology
