#include "core/strip_layout.h"

#include <algorithm>
#include <cmath>

namespace haustra {
namespace {

constexpr double shownUnits = 1.0 + 2.0 * StripLayout::seamMargin;

/// Pixels that `columns` columns side by side may each be wide.
int slotWidth(int columns, int pictureWidth) {
    return (pictureWidth - (columns - 1) * StripLayout::gutter) / columns;
}

}  // namespace

StripLayout layOutStrip(double height, glm::ivec2 size) {
    int count = 1;
    double pixelsPerUnit = 0.0;
    for (int n = 1; slotWidth(n, size.x) >= 1; ++n) {
        const double scale =
            std::min(slotWidth(n, size.x) / shownUnits, double(n) * size.y / height);
        if (scale > pixelsPerUnit) count = n, pixelsPerUnit = scale;
    }

    const int width =
        std::min(slotWidth(count, size.x), int(std::ceil(pixelsPerUnit * shownUnits)));
    const int used = count * width + (count - 1) * StripLayout::gutter;
    StripLayout layout;
    layout.unitsPerColumn = size.y / pixelsPerUnit;
    for (int n = 0; n < count; ++n) {
        StripColumn column;
        column.left = (size.x - used) / 2 + n * (width + StripLayout::gutter);
        column.size = {width, size.y};
        column.window.center = {0.5, (n + 0.5) * layout.unitsPerColumn};
        column.window.pixelsPerUnit = pixelsPerUnit;
        layout.columns.push_back(column);
    }
    return layout;
}

std::optional<glm::dvec2> StripLayout::flatFromPixel(glm::dvec2 pixel, double height) const {
    for (const StripColumn& column : columns) {
        const glm::dvec2 inside = pixel - glm::dvec2(column.left, 0);
        if (inside.x < 0.0 || inside.x >= column.size.x || inside.y < 0.0 ||
            inside.y >= column.size.y) {
            continue;
        }
        const glm::dvec2 flat = column.window.flatFromPixel(inside, column.size);
        if (flat.y < 0.0 || flat.y > height) return std::nullopt;
        return flat;
    }
    return std::nullopt;
}

glm::dvec2 StripLayout::pixelFromFlat(glm::dvec2 flat) const {
    const double place = std::floor(flat.y / unitsPerColumn);
    const StripColumn& column =
        columns[std::size_t(std::clamp(place, 0.0, double(columns.size() - 1)))];
    flat.x -= std::floor(flat.x);
    return column.window.pixelFromFlat(flat, column.size) + glm::dvec2(column.left, 0);
}

}  // namespace haustra
