// Polyps, hyperplastic bumps and stool: what sits on the colon's wall and folds.
#pragma once

#include "phantom/colon_shape.h"
#include "phantom/fluid.h"

namespace haustra::phantom {

/// Adds polyps, hyperplastic bumps and stool to the shape, polyps first. Every polyp's head touches
/// the wall or a fold (or hangs on a stalk from it); polyps keep 25 mm apart and out of collapsed
/// segments.
void addGrowths(ColonShape& shape, std::uint64_t seed, Preset preset, const BodyPlan& body);

/// Adds polyps that the tagged fluid covers, one of them cut by the surface; in `easy`, with its
/// shallow pools, fewer and smaller ones. Fewer still where the pools have no room.
void addSubmergedPolyps(ColonShape& shape, const Fluid& fluid, std::uint64_t seed, Preset preset);

/// The true polyps: centre of the head, largest diameter, kind. Hyperplastic bumps and stool are
/// not findings.
Findings polypsOf(const ColonShape& shape);

}  // namespace haustra::phantom
