// Where the flat strip lies in a picture. The server draws by these, the client points by them.
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// A window onto the flat plane. The picture's columns run towards −x and its rows towards −y, so
/// that the wall is seen from within, the cecum up.
struct FlatWindow {
    glm::dvec2 center{0.5, 0.0};   ///< the flat coordinate in the middle of the picture
    double pixelsPerUnit = 512.0;  ///< pixels a circumference

    /// Of picture coordinates: the centre of pixel (i, j) is (i + ½, j + ½).
    glm::dvec2 flatFromPixel(glm::dvec2 pixel, glm::ivec2 size) const {
        return center - (pixel - 0.5 * glm::dvec2(size)) / pixelsPerUnit;
    }
    glm::dvec2 pixelFromFlat(glm::dvec2 flat, glm::ivec2 size) const {
        return 0.5 * glm::dvec2(size) - (flat - center) * pixelsPerUnit;
    }
    bool operator==(const FlatWindow&) const = default;
};

/// One column of the overview: pixels [left, left + width) × [0, height) of the picture.
struct StripColumn {
    int left = 0;
    glm::ivec2 size{0};
    FlatWindow window;
};

/// The whole strip in one picture: cut into equal lengths side by side, the rectum at the bottom of
/// the left column, each repeating a margin of the circumference past the seam on either side.
/// As many columns as show it largest. A column's window may show nothing above the strip's end.
struct StripLayout {
    static constexpr double seamMargin = 0.08;  ///< of the circumference, on either side
    static constexpr int gutter = 4;            ///< black pixels between columns

    std::vector<StripColumn> columns;  ///< rectum to cecum
    double unitsPerColumn = 0.0;       ///< of y: column c spans c·units … (c + 1)·units

    /// Picture coordinates to flat; empty in a gutter or beyond the strip.
    std::optional<glm::dvec2> flatFromPixel(glm::dvec2 pixel, double height) const;
    /// Where a flat coordinate is drawn; x is taken modulo 1, the copy nearer the column's middle.
    glm::dvec2 pixelFromFlat(glm::dvec2 flat) const;
};

/// Layout of a strip `height` circumferences long (> 0) in a picture of `size` pixels (≥ 1).
StripLayout layOutStrip(double height, glm::ivec2 size);

}  // namespace haustra
