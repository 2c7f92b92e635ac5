// A voxel of a colour volume.
#pragma once

#include <cstdint>

namespace haustra {

/// Colour as displayed (sRGB) and opacity, not multiplied by it; 255 is 1.
struct Rgba {
    std::uint8_t r = 0, g = 0, b = 0, a = 255;
    bool operator==(const Rgba&) const = default;
};
static_assert(sizeof(Rgba) == 4);

}  // namespace haustra
