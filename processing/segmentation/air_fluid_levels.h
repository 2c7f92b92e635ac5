// Air–fluid levels: where tagged fluid stands under gas.
#pragma once

#include "core/tissue.h"
#include "core/volume.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace haustra::segmentation {

/// Down, as the grid sees it: an axis (0 or 1) and a sign.
struct GravityAxis {
    int axis = 1;
    int sign = 1;
    /// Of an oblique grid, or one of a tilted gantry: by how many voxels along the axis a level
    /// plane falls from one voxel to the next along the other of the axes 0 and 1, and along 2.
    glm::dvec2 slope{0.0};

    /// Of a voxel along the axis, without what its place in a level plane makes of it.
    double heightOf(glm::ivec3 voxel) const {
        return voxel[axis] + slope.x * voxel[1 - axis] + slope.y * voxel.z;
    }
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
    /// Median way past soft tissue's HU: from a quarter of the way to gas to half of that to fluid.
    double stepMm = 0.0;
    /// Median distance of where soft tissue's HU begin, beneath the gas, from their own median.
    double topRoughnessMm = 0.0;
    double riseMm = 0.0;  ///< median (riseMm)
};

/// HU over the nine columns around a voxel: fluid that settled is the same along its level.
double meanAlongLevel(const Volume<std::int16_t>& hu, glm::ivec3 voxel, GravityAxis down);

/// How far the tagging's HU may lie beneath a level whose fluid rises to them, mm.
inline constexpr double longestGradientMm = 15.0;
/// The least riseMm of fluid that settled: from a wall to bone it is 2.3 σ of the scan's blur, 2 to
/// 3 mm.
inline constexpr double slowRiseMm = 3.5;
/// How far HU along the level take, beneath a voxel, from where they have passed a wall's, 20 over
/// soft tissue's, to three quarters of the most that they reach within the longest gradient.
double riseMm(const Volume<std::int16_t>& hu, const TissueModel& tissue, glm::ivec3 from,
              GravityAxis down);

/// Flat levels for one direction of gravity (dissertation §3.2: below their air and above their
/// fluid). `content` is Content; gas alone counts as air.
std::vector<Level> findLevels(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                              const Volume<std::uint8_t>& content, GravityAxis down, int threads);

/// How far the scan's blur spreads the edge between gas and soft tissue: the way, mm, over the
/// middle half of its height (1.35 σ), across gas' floors and ceilings along the axis; the median.
/// Empty where fewer than a hundred are seen.
std::optional<double> edgeWidthMm(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                                  const Volume<std::uint8_t>& content, int axis);

}  // namespace haustra::segmentation
