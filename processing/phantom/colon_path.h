// The colon's axis: where it runs in the abdomen, and how wide it is.
#pragma once

#include "phantom/body_plan.h"
#include "phantom/bowel_options.h"
#include "phantom/phantom.h"

#include <vector>

namespace haustra::phantom {

/// One sample of the axis; samples lie `ColonPath::stepMm` apart.
struct PathSample {
    glm::dvec3 position{0.0};
    glm::dvec3 tangent{0, 0, 1};  ///< rectum to cecum
    glm::dvec3 normal{1, 0, 0};   ///< toward the first taenia; turns slowly about the tangent
    glm::dvec3 binormal{0, 1, 0};
    glm::dvec3 curvature{0.0};  ///< dT/ds, 1/mm
    double radiusMm = 0.0;      ///< mean radius of the lumen; below 0 where collapsed
    double haustration = 0.0;   ///< 0 (smooth tube) … 1 (deep sacculations)
};

struct ColonPath {
    std::vector<PathSample> samples;
    double stepMm = 1.0;
    /// Where the axis's radius is that of a closed lumen; it tapers beyond, and the lumen opens
    /// about 2 mm beyond. In order of arc.
    struct Collapse {
        double beginMm = 0.0, endMm = 0.0;
        double taperMm = 18.0;  ///< over which it opens to full width
    };
    std::vector<Collapse> collapses;
    /// Arcs at which the sections end: rectum, sigmoid, descending, transverse, ascending (cecum).
    double rectumEndMm = 0, sigmoidEndMm = 0, descendingEndMm = 0, transverseEndMm = 0;

    double lengthMm() const { return stepMm * double(samples.size() - 1); }
    /// Whether the lumen is closed less than `marginMm` from an arc.
    bool collapsedWithin(double arcMm, double marginMm) const;
    /// The sample interpolated at an arc (clamped to the ends).
    PathSample at(double arcMm) const;
};

/// An anatomical path, varied by the seed: control points from rectum to cecum, made longer or
/// shorter (sigmoid loop, sagging transverse colon) until the length is the one drawn from
/// 1250…1640 mm, then relaxed so that loops, spine, hip bones and abdominal wall keep apart.
/// Neighbouring loops may touch wall to wall. A redundant sigmoid then grows longer by what
/// `bowel` says, or as far as the abdomen lets it.
ColonPath makeColonPath(std::uint64_t seed, Preset preset, const BodyPlan& body,
                        const BowelOptions& bowel = {});

}  // namespace haustra::phantom
