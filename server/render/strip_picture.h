// The whole flattened wall in one tall picture.
#pragma once

#include "render/case_renderer.h"

#include <functional>

namespace haustra::render {

struct StripPicture {
    int pixelsPerCircumference = 400;
    /// How much of the circumference is repeated beyond the seam on either side, 0…0.5.
    double seamMargin = 0.0;
    Optics optics;
    MarchOptions march;
    std::shared_ptr<const WallPaint> paint = nullptr;  ///< as of a CameraView
};

inline constexpr int maxStripRows = 1 << 20;

/// Pixels: the circumference with its margins, and as many rows of square pixels as the strip,
/// `height` circumferences long, fills to the nearest. Fails (badInput) where that is more than
/// maxPixelsPerUnit a circumference or maxStripRows, or the margin is out of range.
Result<glm::ivec2> stripPictureSize(const StripPicture& picture, double height);

/// Draws the strip in bands from the cecum down to the rectum, each of the picture's width, and
/// hands each to `take`; ends where that fails. Every pixel is what render(FlatView) draws there;
/// band by band, a picture of any length needs some 10 MB.
Result<void> drawStrip(CaseRenderer& renderer, const StripPicture& picture, double height,
                       const std::function<Result<void>(const Image&)>& take);

}  // namespace haustra::render
