// Panels, words and lines on pictures (OpenCV).
#pragma once

#include "core/image.h"
#include "core/result.h"

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::pictures {

/// Between the panels of a comparison.
inline constexpr glm::u8vec3 separatorColor{255, 255, 255};
inline constexpr int separatorPixels = 2;

/// The panels from left to right with a separator between any two. They are of one height.
Result<Image> sideBySide(const std::vector<Image>& panels);

/// Words and lines, in pixels from the picture's upper left corner, each with a dark rim, so that
/// it is read on any ground.
struct Marks {
    struct Words {
        std::string text;  ///< printable ASCII
        glm::ivec2 at{0};
        /// Which point of the text is there: {0, 0} its upper left, {1, 1} its lower right corner.
        glm::dvec2 anchor{0.0};
        glm::u8vec3 color{255};
    };
    struct Line {
        glm::ivec2 from{0}, to{0};
        glm::u8vec3 color{255};
    };
    std::vector<Words> words;
    std::vector<Line> lines;
    double textHeight = 10.0;  ///< of a capital letter, pixels
};

/// Pixels from the left to the right of `text`, printable ASCII with capital letters `textHeight`
/// pixels high, as draw writes it; without its rim, two pixels at most.
Result<double> textWidth(const std::string& text, double textHeight);

/// Draws the marks, or what of them lies in the band of the picture whose first row is `firstRow`.
/// The same pixels in whatever bands.
Result<void> draw(const Marks& marks, Image& band, int firstRow = 0);

}  // namespace haustra::pictures
