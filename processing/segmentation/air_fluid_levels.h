// Air–fluid levels: where tagged fluid stands under gas.
#pragma once

#include "core/tissue.h"
#include "core/volume.h"

#include <cstdint>
#include <vector>

namespace haustra::segmentation {

/// Down, as the grid sees it: an axis (0 or 1) and a sign.
struct GravityAxis {
    int axis = 1;
    int sign = 1;
};

/// One column of a level: gas ends at `above`, fluid begins at `below`, with up to a few voxels of
/// partial volume in between.
struct LevelColumn {
    glm::ivec3 above, below;
};

/// A flat patch of columns at one height.
struct Level {
    std::vector<LevelColumn> columns;
    double areaMm2 = 0.0;
    int height = 0;        ///< voxel coordinate of the fluid's surface along the gravity axis
    double fluidHu = 0.0;  ///< median HU just below the surface
    double heightMm =
        0.0;  ///< median of the columns' mid-height crossings along the axis, from voxel 0
    double roughnessMm = 0.0;  ///< median distance of those from heightMm
    double stepMm = 0.0;       ///< median way from the wall's HU over gas to that under fluid
};

/// Flat levels for one direction of gravity (dissertation §3.2: below their air and above their
/// fluid). `content` is Content; gas alone counts as air.
std::vector<Level> findLevels(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                              const Volume<std::uint8_t>& content, GravityAxis down, int threads);

/// Total area of levels, mm²: how a direction of gravity shows in the data.
double totalAreaMm2(const std::vector<Level>& levels);

}  // namespace haustra::segmentation
