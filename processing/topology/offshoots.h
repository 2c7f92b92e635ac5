// Other bowel that a flood of the colon's fluid has run into.
#pragma once

#include "core/volume.h"

#include <cstdint>
#include <span>
#include <vector>

namespace haustra::topology {

/// The voxels of a body of fluid (`pool`, sorted indices) that are a duller body of their own: less
/// than 85 % as bright over soft tissue as `fluidHu` and clearly so for their noise, more than a
/// rim thick, and joined to the rest over a small part of their surface. So is opacified ileum
/// behind its valve or a hole in the blur of a thin wall; a dull patch of unevenly tagged fluid
/// lies open to the rest. Sorted. Linear in the pool's bounding box.
std::vector<std::uint32_t> dullOffshoots(const Volume<std::int16_t>& hu,
                                         std::span<const std::uint32_t> pool, double softHu,
                                         double fluidHu);

}  // namespace haustra::topology
