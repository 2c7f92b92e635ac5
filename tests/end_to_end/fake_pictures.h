// Pictures whose pixels can be computed, and their frames: what the fake server draws.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::tests {

/// Colour of pixel (x, y) of the synthetic picture of a camera or slice at `positionMm`.
std::vector<std::uint8_t> syntheticPicture(int width, int height, glm::dvec3 positionMm,
                                           double centerHu);
/// What stands for the position in a picture of a window onto the strip.
inline glm::dvec3 syntheticPosition(glm::dvec2 center, double pixelsPerCircumference) {
    return {1000.0 * center.x, 100.0 * center.y, pixelsPerCircumference};
}

struct FakePicture {
    int viewport = 0, width = 0, height = 0;
    std::uint32_t number = 0;
    std::uint64_t sequence = 0;
    bool exact = false;
    glm::dvec3 positionMm{0.0};
    double centerHu = 0.0;
    bool garbage = false;  ///< tiles whose JPEG or lossless bytes are noise
};
/// All tile frames of a picture.
std::vector<std::uint8_t> framesOf(const FakePicture& picture);

}  // namespace haustra::tests
