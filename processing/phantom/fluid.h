// Tagged fluid: pools that gravity has levelled.
#pragma once

#include "phantom/colon_field.h"

#include <vector>

namespace haustra::phantom {

inline constexpr double waterHu = 12.0;

/// One stretch of the colon between two high points of its floor, filled up to a level below both.
struct Pool {
    double beginMm = 0.0, endMm = 0.0;  ///< arcs
    double levelMm = -1e9;              ///< height of the surface: −gravity · p
    double riseMm = 0.0;                ///< how far the meniscus climbs the wall
    double hu = 600.0;
    bool tagged = true;       ///< or plain water, or stool
    bool stool = false;       ///< formed stool with bubbles of gas
    double waterMm = 0.0;     ///< how deep plain water stands over what is tagged
    double unevenness = 0.0;  ///< 0…1: how much the tagging varies within the pool
    std::uint64_t seed = 0;

    /// Height of the surface at a signed distance to the lumen's boundary: the meniscus falls off
    /// exponentially from the wall.
    double levelAt(double lumenMm) const;
    /// HU of the fluid at a point; denser toward the bottom.
    double huAt(glm::dvec3 p, double heightMm) const;
    /// How much of the fluid is tagged at a height, 0…1; layers mix over a few millimetres.
    double taggedShareAt(double heightMm) const;
};

struct Fluid {
    glm::dvec3 up{0, -1, 0};
    std::vector<Pool> pools;  ///< in order of arc, covering the whole colon

    double heightMm(glm::dvec3 p) const { return glm::dot(up, p); }
    const Pool& poolAt(double arcMm) const;
};

/// Finds the bays from the lumen's floor (the lowest lumen voxel at each millimetre of arc) and
/// gives each a level. Each level is below the spill points at both ends of its bay, so no pool
/// could flow into the next.
Fluid pourFluid(const ColonShape& shape, const ColonField& field, std::uint64_t seed, Preset preset,
                const BodyPlan& body, const BowelOptions& bowel = {});

}  // namespace haustra::phantom
