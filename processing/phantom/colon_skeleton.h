// The colon's axis before it has samples: control points of the anatomy, laid out in the abdomen
// and relaxed until loops and organs keep apart.
#pragma once

#include "phantom/body_plan.h"
#include "phantom/polyline.h"
#include "phantom/random.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace haustra::phantom {

/// Control points at which the sections end; see ColonPath.
inline constexpr int rectumEnd = 4, sigmoidEnd = 13, descendingEnd = 19, transverseEnd = 27;

/// The lumen's mean radius at a place among the control points, mm.
double radiusAtControl(double control);

/// How far apart along the axis two samples must be before they count as different loops: nearer
/// ones belong to one bend.
inline double loopSeparationMm(double radiusA, double radiusB) {
    return 1.7 * (std::max(radiusA, 2.0) + std::max(radiusB, 2.0) + 3.0);
}

/// What makes one patient's path differ from another's of the same length.
struct Variation {
    Points jitter;                           ///< of the control points
    double sigmoid = 1.0, transverse = 1.0;  ///< shares of the extra length
    double scale = 1.0;                      ///< of the radii
    std::uint64_t waves = 0;                 ///< seed of the axis's meanders
};
Variation drawVariation(Random& random);

struct Skeleton {
    Points nodes;
    std::vector<double> control;  ///< each node's place among the control points
};

/// `redundancy` is the share of the extra length, about −0.2…2: longer colons have longer sigmoid
/// loops and a transverse colon that sags. `sigmoid` is more of the same for the sigmoid alone.
Skeleton layOut(const Variation& vary, double redundancy, const BodyPlan& body,
                double sigmoid = 0.0);

}  // namespace haustra::phantom
