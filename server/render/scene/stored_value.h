// How a volume's HU are stored in its texture.
#pragma once

#include <cstdint>

namespace haustra::render {

/// HU + 32768 in 16 bits, exact for every int16; the shader reads it as a fraction of 65535.
inline constexpr double storedOffset = 32768.0, storedRange = 65535.0;
inline std::uint16_t encodeHu(std::int16_t hu) {
    return std::uint16_t(int(hu) + 32768);
}
inline double storedFraction(double hu) {
    return (hu + storedOffset) / storedRange;
}

}  // namespace haustra::render
