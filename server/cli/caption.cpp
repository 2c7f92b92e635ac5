#include "cli/caption.h"

#include "render/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace haustra::cli {

namespace {

double textHeight(glm::ivec2 size) {
    return std::clamp(std::min(size.x, size.y) / 45.0, 6.0, 24.0);
}

/// The largest of 1, 2, 5, 10, 20 … that is at most `most`.
double roundBelow(double most) {
    const double ten = std::pow(10.0, std::floor(std::log10(most)));
    return ten * (most >= 5.0 * ten ? 5.0 : most >= 2.0 * ten ? 2.0 : 1.0);
}

/// `text`; of one that is over `widest` pixels wide its beginning and its end, as much as fits:
/// the place that a picture shows is told last.
Result<std::string> elided(const std::string& text, double widest, double height) {
    std::string shown = text;
    for (std::size_t kept = text.size(); kept > 0; --kept) {
        if (TRY(pictures::textWidth(shown, height)) <= widest) break;
        shown = text.substr(0, kept / 2) + "..." + text.substr(text.size() - (kept - 1) / 2);
    }
    return shown;
}

/// A part of the picture with marks of its own: all of its rows, from the column `left` on.
struct Panel {
    int left = 0;
    glm::ivec2 size{0};
};

/// Pixels that a mark takes.
struct Box {
    glm::dvec2 low{0.0}, high{0.0};
};

/// Places marks one after another so that all can be read: of what would touch an earlier one, or
/// leave its panel, text goes to a lower row, and what has no place there is left out.
class Layout {
public:
    explicit Layout(double textHeight) { marks_.textHeight = textHeight; }
    pictures::Marks marks() && { return std::move(marks_); }

    double height() const { return marks_.textHeight; }
    /// Between marks and the panel's edge, pixels.
    int gap() const { return int(height() / 2.0) + 2; }
    /// From one row of text to the next, pixels.
    int rowPitch() const { return int(std::ceil(2.0 * height())); }

    /// Whatever is there already: what must be read is added first.
    Result<void> addAlways(const pictures::Marks::Words& words) {
        taken_.push_back(TRY(boxOf(words)));
        marks_.words.push_back(words);
        return {};
    }
    /// With its line, if both have a place there.
    Result<void> addTick(const Panel& panel, const pictures::Marks::Words& words,
                         const pictures::Marks::Line& line) {
        const Box box = TRY(boxOf(words));
        if (!isFree(panel, box)) return {};
        marks_.lines.push_back(line);
        return addAlways(words);
    }
    /// In the highest row that has room for it, from the left on; cut short in its middle where no
    /// row is as wide.
    Result<void> addText(const Panel& panel, const std::string& text) {
        const std::string shown = TRY(elided(text, panel.size.x - 2 * gap(), height()));
        const double width = TRY(pictures::textWidth(shown, height()));
        const auto at = freeCorner(panel, {width, height()});
        if (!at) return {};
        return addAlways({shown, *at, {0.0, 0.0}});
    }
    Result<void> addFrame(const Panel& panel, const PictureFrame& frame);
    Result<void> addBar(const Panel& panel, double mmPerPixel);
    Result<void> addLegend(const Panel& panel);
    /// The last to be added: rings give way to words, numbers to all.
    Result<void> addPlaces(const Panel& panel, const std::vector<NumberedPlace>& places);

private:
    Result<Box> boxOf(const pictures::Marks::Words& words) const {
        const glm::dvec2 size(TRY(pictures::textWidth(words.text, height())), height());
        const glm::dvec2 low = glm::dvec2(words.at) - words.anchor * size;
        return Box{low, low + size};
    }
    bool isFree(const Panel& panel, const Box& box) const {
        // For rims, and for what hangs below a line of text.
        const double apart = 2.0 + height() / 4.0;
        const glm::dvec2 low(panel.left, 0.0), high = low + glm::dvec2(panel.size);
        return glm::all(glm::greaterThanEqual(box.low, low)) &&
               glm::all(glm::lessThanEqual(box.high, high)) &&
               std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) {
                   return glm::all(glm::lessThan(box.low, other.high + apart)) &&
                          glm::all(glm::lessThan(other.low, box.high + apart));
               });
    }
    /// The upper left corner, of a row of text, of a free place of this size.
    std::optional<glm::ivec2> freeCorner(const Panel& panel, glm::dvec2 size) const {
        for (int y = gap(); y < panel.size.y; y += rowPitch()) {
            const glm::ivec2 corner(panel.left + gap(), y);
            if (isFree(panel, {glm::dvec2(corner), glm::dvec2(corner) + size})) return corner;
        }
        return {};
    }

    pictures::Marks marks_;
    std::vector<Box> taken_;
};

/// The letters of the directions at the panel's edges.
Result<void> Layout::addFrame(const Panel& panel, const PictureFrame& frame) {
    const glm::ivec2 size = panel.size;
    const auto letter = [&](glm::dvec3 direction, glm::ivec2 at, glm::dvec2 anchor) {
        return addAlways({orientation(direction), {panel.left + at.x, at.y}, anchor});
    };
    TRY(letter(-frame.right, {gap(), size.y / 2}, {0.0, 0.5}));
    TRY(letter(frame.right, {size.x - gap(), size.y / 2}, {1.0, 0.5}));
    TRY(letter(-frame.down, {size.x / 2, gap()}, {0.5, 0.0}));
    return letter(frame.down, {size.x / 2, size.y - gap()}, {0.5, 1.0});
}

/// Of a round number of millimetres, with that above it, in the lower right corner.
Result<void> Layout::addBar(const Panel& panel, double mmPerPixel) {
    const int low = panel.size.y - gap() - 2, right = panel.left + panel.size.x - gap();
    const double mm = roundBelow(mmPerPixel * panel.size.x / 4.0);
    const int length = int(std::lround(mm / mmPerPixel));
    const pictures::Marks::Words words{
        fmt::format("{:g} mm", mm), {right, low - gap()}, {1.0, 1.0}};
    Box box = TRY(boxOf(words));
    box.low.x = std::min(box.low.x, double(right - length));
    box.high.y = low;
    if (!isFree(panel, box)) return {};
    taken_.push_back(box);
    marks_.words.push_back(words);
    marks_.lines.push_back({{right - length, low}, {right, low}});
    for (const int end : {right - length, right})
        marks_.lines.push_back({{end, low - gap() / 2}, {end, low}});
    return {};
}

/// The tissues' colours, each with its name: all of them, or none.
Result<void> Layout::addLegend(const Panel& panel) {
    const std::array tissues{std::pair("air", render::airColor),
                             std::pair("soft tissue", render::softColor),
                             std::pair("tagged, bone", render::taggedColor),
                             std::pair("air meets tagged", render::interfaceColor)};
    const int side = int(std::lround(height()));
    double widest = 0.0;
    for (const auto& [text, color] : tissues)
        widest = std::max(widest, TRY(pictures::textWidth(text, height())));
    const glm::dvec2 size(side + gap() + widest, rowPitch() * (int(tissues.size()) - 1) + height());
    const auto corner = freeCorner(panel, size);
    if (!corner) return {};
    taken_.push_back({glm::dvec2(*corner), glm::dvec2(*corner) + size});
    glm::ivec2 at = *corner;
    for (const auto& [text, color] : tissues) {
        for (int y = at.y; y < at.y + side; ++y)
            marks_.lines.push_back({{at.x, y}, {at.x + side, y}, color});
        marks_.words.push_back({text, {at.x + side + gap(), at.y}, {0.0, 0.0}});
        at.y += rowPitch();
    }
    return {};
}

Result<void> Layout::addPlaces(const Panel& panel, const std::vector<NumberedPlace>& places) {
    const double radius = 0.6 * height() + 2.0;
    const auto isIn = [](glm::dvec2 at, glm::dvec2 low, glm::dvec2 high) {
        return glm::all(glm::greaterThanEqual(at, low)) && glm::all(glm::lessThan(at, high));
    };
    const std::vector<Box> words = taken_;
    const auto isCovered = [&](glm::dvec2 at) {
        return std::ranges::any_of(
            words, [&](const Box& box) { return isIn(at, box.low - 2.0, box.high + 2.0); });
    };
    std::vector<NumberedPlace> ringed;
    for (const NumberedPlace& place : places) {
        if (!isIn(place.pixel, glm::dvec2(0.0), panel.size)) continue;
        ringed.push_back(place);
        const glm::dvec2 at = place.pixel + glm::dvec2(panel.left, 0.0);
        constexpr int corners = 12;
        const auto corner = [&](int n) {
            const double angle = 2.0 * std::numbers::pi * n / corners;
            return glm::ivec2(
                glm::round(at + radius * glm::dvec2(std::cos(angle), std::sin(angle))));
        };
        for (int n = 0; n < corners; ++n) {
            const pictures::Marks::Line side{corner(n), corner(n + 1), place.color};
            if (!isCovered(0.5 * glm::dvec2(side.from + side.to))) marks_.lines.push_back(side);
        }
        taken_.push_back({at - radius, at + radius});
    }
    for (const NumberedPlace& place : ringed) {
        const glm::dvec2 at = place.pixel + glm::dvec2(panel.left, 0.0);
        const double away = radius + 0.25 * height() + 3.0;
        for (const glm::dvec2 side : {glm::dvec2(1, 0), {-1, 0}, {0, -1}, {0, 1}}) {
            const pictures::Marks::Words number{std::to_string(place.number),
                                                glm::ivec2(glm::round(at + away * side)),
                                                0.5 - 0.5 * side, place.color};
            if (!isFree(panel, TRY(boxOf(number)))) continue;
            TRY(addAlways(number));
            break;
        }
    }
    return {};
}

/// Of each camera that sees any of the wall: its arc length, mm, and its row of a picture of the
/// strip `rows` high: the middle of what it sees.
std::vector<glm::dvec2> camerasOnStrip(const FlatMap& map, int rows) {
    std::vector<double> sum(map.cameras.size()), count(map.cameras.size());
    for (std::size_t v = 0; v < map.flat.size(); ++v) {
        sum[std::size_t(map.camera[v])] += map.flat[v].y;
        count[std::size_t(map.camera[v])] += 1.0;
    }
    std::vector<glm::dvec2> places;
    for (std::size_t c = 0; c < sum.size(); ++c)
        if (count[c] > 0.0)
            places.emplace_back(map.cameras[c].arcMm,
                                (1.0 - sum[c] / count[c] / map.height) * rows);
    return places;
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

Result<pictures::Marks> caption(const std::string& line, const std::optional<PictureFrame>& frame,
                                glm::ivec2 size, const std::vector<NumberedPlace>& places) {
    Layout layout(textHeight(size));
    const Panel whole{0, size};
    if (frame) {
        TRY(layout.addFrame(whole, *frame));
        TRY(layout.addBar(whole, frame->mmPerPixel));
    }
    TRY(layout.addText(whole, line));
    TRY(layout.addPlaces(whole, places));
    return std::move(layout).marks();
}

Result<pictures::Marks> comparisonCaption(const std::string& line, const PictureFrame& frame,
                                          glm::ivec2 size) {
    Layout layout(textHeight(size));
    const int step = size.x + pictures::separatorPixels;
    const Panel before{0, size}, tissues{step, size}, after{2 * step, size};
    for (const Panel& panel : {before, tissues, after})
        TRY(layout.addFrame(panel, frame));
    TRY(layout.addBar(before, frame.mmPerPixel));
    TRY(layout.addText(before, "before"));
    TRY(layout.addText(tissues, "tissues"));
    TRY(layout.addText(after, "after"));
    TRY(layout.addLegend(tissues));
    TRY(layout.addText(before, line));
    return std::move(layout).marks();
}

Result<pictures::Marks> stripCaption(const FlatMap& map, glm::ivec2 size,
                                     const std::vector<NumberedPlace>& places) {
    Layout layout(std::clamp(size.x / 40.0, 6.0, 24.0));
    const int gap = layout.gap();
    TRY(layout.addAlways({"cecum", {size.x / 2, gap}, {0.5, 0.0}}));
    TRY(layout.addAlways({"rectum", {size.x / 2, size.y - gap}, {0.5, 1.0}}));
    const auto cameras = camerasOnStrip(map, size.y);
    if (cameras.size() < 2) {
        TRY(layout.addPlaces({0, size}, places));
        return std::move(layout).marks();
    }
    const double length = cameras.back().x - cameras.front().x;
    const double ticks = std::max(1.0, size.y / (6.0 * layout.height()));
    const double least = std::max(length / ticks, 1.0);
    const double step = roundBelow(least) < least ? roundBelow(2.5 * least) : least;
    std::size_t at = 0;
    for (double arc = std::ceil(cameras.front().x / step) * step; arc <= cameras.back().x;
         arc += step) {
        while (at + 2 < cameras.size() && cameras[at + 1].x < arc)
            ++at;
        const glm::dvec2 low = cameras[at], high = cameras[at + 1];
        const double part = (arc - low.x) / std::max(high.x - low.x, 1e-9);
        const int row = int(std::lround(glm::mix(low.y, high.y, std::clamp(part, 0.0, 1.0))));
        const int beside = std::clamp(row, gap, std::max(gap, size.y - gap));  // whole at the ends
        TRY(layout.addTick({0, size}, {fmt::format("{:g} mm", arc), {3 * gap, beside}, {0.0, 0.5}},
                           {{0, row}, {2 * gap, row}}));
    }
    TRY(layout.addPlaces({0, size}, places));
    return std::move(layout).marks();
}

}  // namespace haustra::cli
