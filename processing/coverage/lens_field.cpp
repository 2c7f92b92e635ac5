#include "coverage/lens_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haustra::coverage {

FieldEllipse wholePicture(glm::ivec2 size) {
    return {0.5 * (glm::dvec2(size) - 1.0), glm::dvec2(size) / std::numbers::sqrt2};
}

double fieldWithin(const FisheyeLens& lens, const FieldEllipse& open, glm::ivec2 pictureSize) {
    constexpr int samples = 720;
    double widest = 0.0;
    for (int n = 0; n < samples; ++n) {
        const double angle = 2.0 * std::numbers::pi * n / samples;
        const glm::dvec2 edge =
            open.center + open.radii * glm::dvec2(std::cos(angle), std::sin(angle));
        const auto direction =
            directionOf(lens, glm::clamp(edge, glm::dvec2(0.0), glm::dvec2(pictureSize - 1)));
        // Past the edge of what the lens shows.
        widest = std::max(widest, direction ? std::acos(std::clamp(direction->z, -1.0, 1.0))
                                            : largestAngle(lens));
    }
    return glm::degrees(2.0 * widest);
}

}  // namespace haustra::coverage
