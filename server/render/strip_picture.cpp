#include "render/strip_picture.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace haustra::render {

namespace {

constexpr int bandPixels = 1 << 22, mostBandRows = 1024;

int marginPixels(const StripPicture& picture) {
    return int(std::lround(picture.seamMargin * picture.pixelsPerCircumference));
}

}  // namespace

Result<glm::ivec2> stripPictureSize(const StripPicture& picture, double height) {
    if (!(picture.seamMargin >= 0.0 && picture.seamMargin <= 0.5))
        return fail(ErrorKind::badInput, "the margin is not within 0 to 0.5", "flat image");
    const double rows = std::max(1.0, std::round(height * picture.pixelsPerCircumference));
    if (!(picture.pixelsPerCircumference >= 1 &&
          picture.pixelsPerCircumference <= maxPixelsPerUnit && rows <= maxStripRows))
        return fail(ErrorKind::badInput,
                    "at " + std::to_string(picture.pixelsPerCircumference) +
                        " pixels a circumference the picture is not within 1x1 to " +
                        std::to_string(maxPixelsPerUnit) + "x" + std::to_string(maxStripRows),
                    "flat image");
    return glm::ivec2(picture.pixelsPerCircumference + 2 * marginPixels(picture), int(rows));
}

Result<void> drawStrip(CaseRenderer& renderer, const StripPicture& picture, double height,
                       const std::function<Result<void>(const Image&)>& take) {
    const auto size = TRY(stripPictureSize(picture, height));
    const double pixels = picture.pixelsPerCircumference;
    // The flat coordinates of the picture's top left corner, in pixels.
    const glm::dvec2 edge(picture.pixelsPerCircumference + marginPixels(picture), size.y);
    FlatView view{{}, picture.optics, picture.march, picture.paint};
    view.window.pixelsPerUnit = pixels;
    const int bandRows = std::clamp(bandPixels / size.x, 1, mostBandRows);
    for (int top = 0; top < size.y; top += bandRows) {
        Image band{size.x, std::min(bandRows, size.y - top), {}};
        band.rgb.resize(3 * std::size_t(band.width) * std::size_t(band.height));
        for (int left = 0; left < size.x; left += maxPictureSide) {
            const int width = std::min(maxPictureSide, size.x - left);
            view.window.center =
                (edge - glm::dvec2(left + 0.5 * width, top + 0.5 * band.height)) / pixels;
            const auto tile = TRY(renderer.render(view, width, band.height));
            for (int y = 0; y < band.height; ++y)
                std::copy_n(
                    &tile.rgb[3 * std::size_t(width) * std::size_t(y)], 3 * width,
                    &band.rgb[3 * (std::size_t(band.width) * std::size_t(y) + std::size_t(left))]);
        }
        TRY(take(band));
    }
    return {};
}

}  // namespace haustra::render
