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

}  // namespace haustra::topology
