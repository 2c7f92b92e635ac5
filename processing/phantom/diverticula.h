// Pouches of the colon's wall.
#pragma once

#include "phantom/colon_shape.h"

namespace haustra::phantom {

/// Adds up to `count` diverticula with sacs of 4 to 9 mm, four fifths of them in the sigmoid and
/// none in the rectum, clear of growths, the valve, other loops and each other. Fewer where there
/// is no room.
void addDiverticula(ColonShape& shape, std::uint64_t seed, int count);

}  // namespace haustra::phantom
