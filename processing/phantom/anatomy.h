// The abdomen around the colon.
#pragma once

#include "phantom/phantom.h"
#include "phantom/solid.h"

namespace haustra::phantom {

/// Air, table, skin, fat, muscle, lung bases, liver, spleen, kidneys, vessels and bones, in
/// painting order. They do not depend on the colon, which is painted over them.
std::vector<Solid> makeAnatomy(std::uint64_t seed, const BodyPlan& body);

/// A hip prosthesis in place of one hip joint, painted after the anatomy.
std::vector<Solid> makeMetalHip(std::uint64_t seed);

/// Stomach and small bowel with gas, fluid and (but for `easy`) opacified fluid, each with its own
/// level; in `standard` and `hard` some loops lie against the colon, wall to wall. Painted after
/// the anatomy.
std::vector<Solid> makeOtherBowel(std::uint64_t seed, Preset preset, const BodyPlan& body);

}  // namespace haustra::phantom
