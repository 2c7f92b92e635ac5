#include "cli/caption.h"

#include "render/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace haustra::cli {

namespace {

double textHeight(glm::ivec2 size) {
    return std::clamp(size.y / 45.0, 6.0, 24.0);
}

/// The largest of 1, 2, 5, 10, 20 … that is at most `most`.
double roundBelow(double most) {
    const double ten = std::pow(10.0, std::floor(std::log10(most)));
    return ten * (most >= 5.0 * ten ? 5.0 : most >= 2.0 * ten ? 2.0 : 1.0);
}

void addFrame(pictures::Marks& marks, const PictureFrame& frame, glm::ivec2 size, int left) {
    const int gap = int(marks.textHeight / 2.0) + 2;
    const auto letter = [&](glm::dvec3 direction, glm::ivec2 at, glm::dvec2 anchor) {
        marks.words.push_back({orientation(direction), {left + at.x, at.y}, anchor});
    };
    letter(-frame.right, {gap, size.y / 2}, {0.0, 0.5});
    letter(frame.right, {size.x - gap, size.y / 2}, {1.0, 0.5});
    letter(-frame.down, {size.x / 2, gap}, {0.5, 0.0});
    letter(frame.down, {size.x / 2, size.y - gap}, {0.5, 1.0});
}

void addBar(pictures::Marks& marks, double mmPerPixel, glm::ivec2 size) {
    const int gap = int(marks.textHeight / 2.0) + 2, low = size.y - gap - 2;
    const double mm = roundBelow(mmPerPixel * size.x / 4.0);
    const int length = int(std::lround(mm / mmPerPixel)), right = size.x - gap;
    marks.lines.push_back({{right - length, low}, {right, low}});
    for (const int end : {right - length, right})
        marks.lines.push_back({{end, low - gap / 2}, {end, low}});
    marks.words.push_back({fmt::format("{:g} mm", mm), {right, low - gap}, {1.0, 1.0}});
}

}  // namespace

PictureFrame frameOf(const SlicePlacement& placement) {
    return {glm::normalize(placement.rightMm), glm::normalize(placement.downMm),
            glm::length(placement.rightMm)};
}

std::optional<PictureFrame> frameOf(const Camera& camera, int pictureHeight) {
    if (camera.lens != Lens::orthographic) return {};
    const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    return PictureFrame{right, glm::normalize(glm::cross(camera.forward, right)),
                        camera.heightMm / pictureHeight};
}

std::string orientation(glm::dvec3 direction) {
    constexpr std::array letters{std::pair('R', 'L'), std::pair('A', 'P'), std::pair('F', 'H')};
    std::array axes{0, 1, 2};
    const auto along = [&](int axis) { return std::abs(direction[axis]); };
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return along(a) > along(b); });
    std::string text;
    for (const int axis : {axes[0], axes[1]}) {
        // A second letter where it points at least half as much that way.
        if (!text.empty() && along(axis) < 0.5 * along(axes[0])) break;
        const auto [less, more] = letters[std::size_t(axis)];
        text += direction[axis] < 0.0 ? less : more;
    }
    return text;
}

pictures::Marks caption(const std::string& line, const std::optional<PictureFrame>& frame,
                        glm::ivec2 size) {
    pictures::Marks marks;
    marks.textHeight = textHeight(size);
    const int gap = int(marks.textHeight / 2.0) + 2;
    marks.words.push_back({line, {gap, gap}, {0.0, 0.0}});
    if (frame) {
        addFrame(marks, *frame, size, 0);
        addBar(marks, frame->mmPerPixel, size);
    }
    return marks;
}

pictures::Marks comparisonCaption(const std::string& line, const PictureFrame& frame,
                                  glm::ivec2 size) {
    pictures::Marks marks = caption(line, frame, size);
    const int gap = int(marks.textHeight / 2.0) + 2, row = int(std::ceil(2.0 * marks.textHeight));
    const int step = size.x + pictures::separatorPixels;
    for (const int panel : {1, 2})
        addFrame(marks, frame, size, panel * step);
    const auto title = [&](const char* text, int panel, int line_) {
        marks.words.push_back({text, {panel * step + gap, gap + line_ * row}, {0.0, 0.0}});
    };
    title("before", 0, 1);
    title("tissues", 1, 0);
    title("after", 2, 0);
    int below = gap;
    const int side = int(std::lround(marks.textHeight));
    for (const auto& [text, color] :
         {std::pair("air", render::airColor), std::pair("soft tissue", render::softColor),
          std::pair("tagged, bone", render::taggedColor),
          std::pair("air meets tagged", render::interfaceColor)}) {
        below += row;
        for (int y = below; y < below + side; ++y)
            marks.lines.push_back({{step + gap, y}, {step + gap + side, y}, color});
        marks.words.push_back({text, {step + 2 * gap + side, below}, {0.0, 0.0}});
    }
    return marks;
}

pictures::Marks stripCaption(const FlatMap& map, glm::ivec2 size) {
    pictures::Marks marks;
    marks.textHeight = std::clamp(size.x / 40.0, 6.0, 24.0);
    const int gap = int(marks.textHeight / 2.0) + 2;
    marks.words.push_back({"cecum", {size.x / 2, gap}, {0.5, 0.0}});
    marks.words.push_back({"rectum", {size.x / 2, size.y - gap}, {0.5, 1.0}});

    // Each camera's place on the strip: the middle of what it sees.
    std::vector<double> sum(map.cameras.size()), count(map.cameras.size());
    for (std::size_t v = 0; v < map.flat.size(); ++v) {
        sum[std::size_t(map.camera[v])] += map.flat[v].y;
        count[std::size_t(map.camera[v])] += 1.0;
    }
    std::vector<glm::dvec2> places;  // arc, row
    for (std::size_t c = 0; c < sum.size(); ++c)
        if (count[c] > 0.0)
            places.emplace_back(map.cameras[c].arcMm,
                                (1.0 - sum[c] / count[c] / map.height) * size.y);
    if (places.size() < 2) return marks;
    const double length = places.back().x - places.front().x;
    const double ticks = std::max(1.0, size.y / (6.0 * marks.textHeight));
    const double least = std::max(length / ticks, 1.0);
    const double step = roundBelow(least) < least ? roundBelow(2.5 * least) : least;
    std::size_t at = 0;
    for (double arc = std::ceil(places.front().x / step) * step; arc <= places.back().x;
         arc += step) {
        while (at + 2 < places.size() && places[at + 1].x < arc)
            ++at;
        const glm::dvec2 low = places[at], high = places[at + 1];
        const double part = (arc - low.x) / std::max(high.x - low.x, 1e-9);
        const int row = int(std::lround(glm::mix(low.y, high.y, std::clamp(part, 0.0, 1.0))));
        marks.lines.push_back({{0, row}, {2 * gap, row}});
        marks.words.push_back({fmt::format("{:g} mm", arc), {3 * gap, row}, {0.0, 0.5}});
    }
    return marks;
}

}  // namespace haustra::cli
