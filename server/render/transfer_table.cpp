#include "render/transfer_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haustra::render {

namespace {

/// Colours are named as displayed (sRGB); light adds up linearly.
double linearLight(double displayed) {
    return displayed <= 0.04045 ? displayed / 12.92 : std::pow((displayed + 0.055) / 1.055, 2.4);
}

}  // namespace

bool TransferTable::anyVisible(double lowHu, double highHu) const {
    const double perHu = (entries - 1) / (lastHu - firstHu);
    const int low = std::clamp(int(std::floor((lowHu - firstHu) * perHu)), 0, entries - 1);
    const int high = std::clamp(int(std::ceil((highHu - firstHu) * perHu)), 0, entries - 1);
    return visibleBefore[std::size_t(high) + 1] > visibleBefore[std::size_t(low)];
}

TransferTable makeTransferTable(const TransferFunction& transferFunction, double stepMm) {
    const auto& points = transferFunction.points;
    TransferTable table;
    table.firstHu = points.front().hu;
    table.lastHu = points.back().hu;
    table.rgba.resize(TransferTable::entries);
    table.visibleBefore.assign(TransferTable::entries + 1, 0);
    const double huPerEntry = (table.lastHu - table.firstHu) / (TransferTable::entries - 1);
    std::size_t segment = 0;
    int first = TransferTable::entries, last = -1;
    for (int i = 0; i < TransferTable::entries; ++i) {
        const double hu =
            i + 1 == TransferTable::entries ? table.lastHu : table.firstHu + i * huPerEntry;
        while (segment + 2 < points.size() && hu >= points[segment + 1].hu)
            ++segment;
        const TransferFunctionPoint &a = points[segment], &b = points[segment + 1];
        const double share = b.hu > a.hu ? std::clamp((hu - a.hu) / (b.hu - a.hu), 0.0, 1.0) : 1.0;
        const glm::dvec3 color = glm::mix(a.color, b.color, share);
        const double opacity = 1.0 - std::pow(1.0 - glm::mix(a.opacity, b.opacity, share), stepMm);
        table.rgba[std::size_t(i)] =
            glm::vec4(linearLight(color.r), linearLight(color.g), linearLight(color.b), opacity);
        const bool visible = table.rgba[std::size_t(i)].a > 0.0f;
        table.visibleBefore[std::size_t(i) + 1] =
            table.visibleBefore[std::size_t(i)] + (visible ? 1 : 0);
        if (visible) first = std::min(first, i), last = i;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    table.visibleAboveHu = first == 0 ? -infinity : table.firstHu + (first - 1) * huPerEntry;
    table.visibleBelowHu =
        last == TransferTable::entries - 1 ? infinity : table.firstHu + (last + 1) * huPerEntry;
    return table;
}

}  // namespace haustra::render
