// How high the tagged fluid stands.
#pragma once

#include "cleansing/interface_layer.h"
#include "cleansing/local_means.h"
#include "cleansing/tagged_surroundings.h"
#include "core/ct_scan.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace haustra::cleansing {

/// The height of the fluid's surface to a fraction of a voxel: where bare, flat air–fluid
/// interfaces stand half-way between air and fluid (dissertation §3.2). It is known beside them
/// too, since a fluid's surface is level: at a wall, where air, fluid and soft tissue share a
/// voxel, the level tells how much of what is not wall is fluid. Near a meniscus, where the surface
/// is not level, the nearest columns of voxels give its height.
class WaterLevel {
public:
    /// `gravity` (unit, LPS) must lie within 18° of a grid axis, else there is no level.
    WaterLevel(const CtScan& scan, const LocalMeans& means, const InterfaceLayer& interfaces,
               const TaggedSurroundings& around, glm::dvec3 gravity, int threads);

    /// Depth of a voxel's centre below the level, mm (negative above), where one is known within
    /// 3 mm of height and 6 across. Thread-safe.
    std::optional<double> depthMm(glm::ivec3 voxel) const;

    /// Whether a level can be known at a voxel: cheap, and false in most places. Thread-safe.
    bool near(glm::ivec3 voxel) const {
        return !blocks_.empty() && blocks_.at(voxel / blockVoxels_) != 0;
    }

    /// Whether a level lies straight above, at the end of a column of `segmentation`'s tagged
    /// voxels with gaps of at most 2.3 mm, or within 6 mm across of it. Thread-safe.
    bool standsAbove(glm::ivec3 voxel, const Volume<std::uint8_t>& segmentation) const;

    /// Along the grid: a unit step down. Zero where there is no gravity.
    glm::ivec3 down() const { return down_; }

private:
    /// The level crosses between the voxel at this height of its column and the one below it.
    struct Crossing {
        std::int32_t height;  ///< along the grid's vertical axis
        std::int32_t part;    ///< of the way between their centres, in 254ths
    };

    struct Found {
        std::size_t column;
        Crossing crossing;
    };

    /// Which way the grid's axes lie to gravity, and what follows from it.
    void findAxes(glm::dvec3 gravity);
    void keep(const std::vector<Found>& sorted);
    void markBlocks(const std::vector<Found>& found);

    /// Calls visit(voxel, crossing) for those in the columns around a voxel, as they are looked at.
    template <class Visit>
    void eachCrossing(glm::ivec3 voxel, double acrossMm, double heightMm, const Visit& visit) const;

    std::size_t columnOf(glm::ivec3 v) const {
        return std::size_t(v[across_[0]]) +
               std::size_t(grid_.size[across_[0]]) * std::size_t(v[across_[1]]);
    }

    Grid grid_;
    glm::ivec3 down_{0};
    int vertical_ = 1;
    glm::ivec2 across_{0, 2};
    double stepMm_ = 1.0;
    std::vector<Crossing> crossings_;           ///< by column, and from low heights to high
    std::vector<std::uint32_t> firstOfColumn_;  ///< in crossings_, and the end
    glm::ivec3 acrossStep_{1};                  ///< columns that are looked at lie so far apart
    double fewestColumns_ = 12.0;               ///< that make a level
    glm::ivec3 blockVoxels_{4};                 ///< 3 mm
    Volume<std::uint8_t> blocks_;  ///< 1 where a crossing is 1 block above or below, 2 across
};

}  // namespace haustra::cleansing
