// A picture in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// Rows from the top, 3 bytes a pixel: sRGB.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// A black one.
inline Image blankImage(glm::ivec2 size) {
    return {size.x, size.y,
            std::vector<std::uint8_t>(3 * std::size_t(size.x) * std::size_t(size.y))};
}

}  // namespace haustra
