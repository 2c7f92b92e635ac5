#include "cli/calibration_picture.h"

#include "pictures/drawing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace haustra::cli {
namespace {

constexpr int panelWidth = 460, gap = 10, headHeight = 26, titleHeight = 34, mostColumns = 4;
constexpr double longestPixels = 30.0;
constexpr glm::u8vec3 crossColor{90, 220, 120}, lineColor{255, 190, 60};

/// Of the panel's size, at two fifths of its brightness, by the nearest pixel.
void paint(const Image& image, glm::ivec2 at, glm::ivec2 size, Image& onto) {
    for (int y = 0; y < size.y; ++y) {
        const int fromY = int((y + 0.5) * image.height / size.y);
        for (int x = 0; x < size.x; ++x) {
            const int fromX = int((x + 0.5) * image.width / size.x);
            for (std::size_t c = 0; c < 3; ++c)
                onto.rgb[3 * (std::size_t(at.y + y) * std::size_t(onto.width) +
                              std::size_t(at.x + x)) +
                         c] =
                    std::uint8_t(0.4 *
                                 image.rgb[3 * (std::size_t(fromY) * std::size_t(image.width) +
                                                std::size_t(fromX)) +
                                           c]);
        }
    }
}

}  // namespace

Result<Image> residualPicture(const std::vector<CalibratedPicture>& pictures, double rmsPixels) {
    if (pictures.empty()) return fail(ErrorKind::badInput, "there is no picture to draw on");
    double longest = 1e-6;
    for (const CalibratedPicture& picture : pictures)
        longest = std::max(longest, picture.fit->largestPixels);
    const Image& first = *pictures.front().image;
    const double scale = double(panelWidth) / first.width;
    const glm::ivec2 panel(panelWidth, int(std::lround(scale * first.height)));
    const double factor = longestPixels / (scale * longest);

    const int columns = std::min(mostColumns, int(pictures.size())),
              rows = (int(pictures.size()) + columns - 1) / columns;
    Image whole = blankImage(
        {columns * (panel.x + gap) + gap, titleHeight + rows * (panel.y + headHeight + gap)});
    pictures::Marks marks;
    marks.words.push_back(
        {fmt::format("found to fitted, {:.3g} times longer: the longest is {:.3f} "
                     "pixels; RMS {:.3f} pixels",
                     factor, longest, rmsPixels),
         {gap, 10},
         {0.0, 0.0}});
    for (std::size_t n = 0; n < pictures.size(); ++n) {
        const CalibratedPicture& picture = pictures[n];
        const glm::ivec2 corner(gap + int(n) % columns * (panel.x + gap),
                                titleHeight + int(n) / columns * (panel.y + headHeight + gap));
        const glm::ivec2 at = corner + glm::ivec2(0, headHeight);
        paint(*picture.image, at, panel, whole);
        marks.words.push_back({fmt::format("{}  {:.3f} px", picture.name, picture.fit->rmsPixels),
                               corner + glm::ivec2(2, 8),
                               {0.0, 0.0}});
        const auto place = [&](glm::dvec2 pixel) {
            return at + glm::ivec2(glm::round((pixel + 0.5) * scale - 0.5));
        };
        for (std::size_t i = 0; i < picture.view->pixels.size(); ++i) {
            const glm::dvec2 found = picture.view->pixels[i];
            const glm::ivec2 from = place(found);
            for (const glm::ivec2 arm : {glm::ivec2(2, 0), glm::ivec2(0, 2)})
                marks.lines.push_back({from - arm, from + arm, crossColor});
            marks.lines.push_back(
                {from, place(found - factor * picture.fit->residuals[i]), lineColor});
        }
    }
    TRY(pictures::draw(marks, whole));
    return whole;
}

}  // namespace haustra::cli
