#include "coverage/undistort.h"

#include <algorithm>
#include <cmath>

namespace haustra::coverage {

Image undistorted(const Image& picture, const FisheyeLens& lens) {
    const glm::dvec2 middle = 0.5 * (glm::dvec2(picture.width, picture.height) - 1.0);
    const double side = std::min(picture.width, picture.height);
    constexpr double widest = 55.0;
    const auto edge =
        directionOf(lens, glm::dvec2(lens.u0, lens.v0) + (picture.width < picture.height
                                                              ? glm::dvec2(0.5 * side, 0.0)
                                                              : glm::dvec2(0.0, 0.5 * side)));
    const double half =
        std::min(edge ? std::acos(std::clamp(edge->z, -1.0, 1.0)) : largestAngle(lens),
                 glm::radians(widest));
    const double focal = 0.5 * side / std::tan(half);
    Image result = blankImage({picture.width, picture.height});
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const auto at = pixelOf(lens, {(x - middle.x) / focal, (y - middle.y) / focal, 1.0});
            if (!at || !(at->x >= 0.0 && at->y >= 0.0 && at->x <= picture.width - 1.0 &&
                         at->y <= picture.height - 1.0))
                continue;
            const int left = std::min(int(at->x), picture.width - 2),
                      top = std::min(int(at->y), picture.height - 2);
            if (left < 0 || top < 0) continue;  // a picture of one row or column
            const double a = at->x - left, b = at->y - top;
            const std::size_t row = 3 * std::size_t(picture.width),
                              from = row * std::size_t(top) + 3 * std::size_t(left);
            for (std::size_t c = 0; c < 3; ++c) {
                const std::uint8_t* p = &picture.rgb[from + c];
                const double value =
                    (1 - b) * ((1 - a) * p[0] + a * p[3]) + b * ((1 - a) * p[row] + a * p[row + 3]);
                result.rgb[row * std::size_t(y) + 3 * std::size_t(x) + c] =
                    std::uint8_t(value + 0.5);
            }
        }
    }
    return result;
}

}  // namespace haustra::coverage
