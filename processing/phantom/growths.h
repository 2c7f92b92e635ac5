// Polyps, hyperplastic bumps and stool: what sits on the colon's wall and folds.
#pragma once

#include "phantom/colon_shape.h"
#include "phantom/fluid.h"
#include "phantom/growth_options.h"

namespace haustra::phantom {

/// Adds polyps, hyperplastic bumps and stool to the shape, polyps first. Every polyp's head touches
/// the wall or a fold (or hangs on a stalk from it); polyps keep 25 mm apart and out of collapsed
/// segments.
void addGrowths(ColonShape& shape, std::uint64_t seed, Preset preset, const BodyPlan& body);

/// Adds polyps that the tagged fluid covers, one of them cut by the surface; in `easy`, with its
/// shallow pools, fewer and smaller ones. Fewer still where the pools have no room.
void addSubmergedPolyps(ColonShape& shape, const Fluid& fluid, std::uint64_t seed, Preset preset);

/// Adds what the options say beyond the preset's, as far as there is room.
void addMoreGrowths(ColonShape& shape, std::uint64_t seed, const GrowthOptions& options,
                    const BodyPlan& body);

/// The true polyps: centre of the head, largest diameter, kind. Hyperplastic bumps and stool are
/// not findings.
Findings polypsOf(const ColonShape& shape);

}  // namespace haustra::phantom
