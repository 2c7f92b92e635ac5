#include "render/optics/transfer_table.h"

#include "core/srgb.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haustra::render {

namespace {

using Points = std::vector<TransferFunctionPoint>;

/// Colour as displayed, and opacity for 1 mm, at HU that never fall from call to call.
class RisingLookup {
public:
    explicit RisingLookup(const Points& points) : points_(points) {}
    glm::dvec4 at(double hu) {
        while (segment_ + 2 < points_.size() && hu >= points_[segment_ + 1].hu)
            ++segment_;
        const TransferFunctionPoint &a = points_[segment_], &b = points_[segment_ + 1];
        const double share = b.hu > a.hu ? std::clamp((hu - a.hu) / (b.hu - a.hu), 0.0, 1.0) : 1.0;
        return {glm::mix(a.color, b.color, share), glm::mix(a.opacity, b.opacity, share)};
    }

private:
    const Points& points_;
    std::size_t segment_ = 0;
};

/// Colours are named as displayed.
glm::dvec3 linearLight(glm::dvec3 color) {
    using haustra::linearLight;
    return {linearLight(color.r), linearLight(color.g), linearLight(color.b)};
}

double huOfEntry(const TransferTable& table, double entry) {
    return table.firstHu + entry * (table.lastHu - table.firstHu) / (TransferTable::entries - 1);
}

/// Row `row` of the table is the mixture of two rows of the function.
void fillRow(TransferTable& table, int row, const Points& low, const Points& high, double share,
             double opacityExponent) {
    RisingLookup a(low), b(high);
    for (int i = 0; i < TransferTable::entries; ++i) {
        const double hu =
            i + 1 == TransferTable::entries ? table.lastHu : huOfEntry(table, double(i));
        const glm::dvec4 here = share > 0.0 ? glm::mix(a.at(hu), b.at(hu), share) : a.at(hu);
        table.rgba[std::size_t(row) * TransferTable::entries + std::size_t(i)] =
            glm::vec4(glm::vec3(linearLight(glm::dvec3(here))),
                      float(1.0 - std::pow(1.0 - here.a, opacityExponent)));
    }
}

void fillRows(TransferTable& table, const TransferFunction& function, double opacityExponent) {
    table.rows = TransferTable::gradientRows;
    table.lastRowHuPerMm = function.rows.back().gradientHuPerMm;
    table.rgba.resize(std::size_t(table.rows) * TransferTable::entries);
    for (int row = 0; row < table.rows; ++row) {
        const double magnitude = table.lastRowHuPerMm * row / (table.rows - 1);
        const auto above =
            std::find_if(function.rows.begin(), function.rows.end() - 1,
                         [&](const GradientRow& r) { return r.gradientHuPerMm >= magnitude; });
        const bool first = above == function.rows.begin();
        const double from = first ? 0.0 : (above - 1)->gradientHuPerMm;
        const double share =
            std::clamp((magnitude - from) / (above->gradientHuPerMm - from), 0.0, 1.0);
        fillRow(table, row, first ? function.points : (above - 1)->points, above->points, share,
                opacityExponent);
    }
}

glm::dvec4 extinctionOf(glm::dvec4 here, double stepMm) {
    const double extinction = -stepMm * std::log(std::max(1.0 - here.a, std::exp2(-14.0)));
    return {linearLight(glm::dvec3(here)) * extinction, extinction};
}

/// Fills the integrals. Marks of every two neighbouring entries with extinction between them one,
/// not the first or last of the table: beyond it there may be none.
std::vector<bool> integrate(TransferTable& table, const Points& points, double stepMm) {
    // Midpoints of quarters see what is thinner than an entry.
    constexpr int parts = 4;
    std::vector<bool> shown(TransferTable::entries, false);
    RisingLookup lookup(points);
    table.integrals.assign(TransferTable::entries, glm::vec4(0.0f));
    glm::dvec4 sum(0.0);
    for (int i = 1; i < TransferTable::entries; ++i) {
        for (int part = 0; part < parts; ++part) {
            const double hu = huOfEntry(table, i - 1 + (part + 0.5) / parts);
            const glm::dvec4 here = extinctionOf(lookup.at(hu), stepMm);
            sum += here / double(parts);
            if (here.a > 0.0) shown[std::size_t(std::min(i, TransferTable::entries - 2))] = true;
        }
        table.integrals[std::size_t(i)] = glm::vec4(sum);
    }
    table.integralBelow = extinctionOf({points.front().color, points.front().opacity}, stepMm);
    table.integralAbove = extinctionOf({points.back().color, points.back().opacity}, stepMm);
    return shown;
}

bool canShow(const TransferTable& table, const Optics& optics, int entry) {
    for (int row = 0; row < table.rows; ++row) {
        const float opacity =
            table.rgba[std::size_t(row) * TransferTable::entries + std::size_t(entry)].a;
        if (optics.composition == Composition::firstHit ? opacity >= float(firstHitOpacity)
                                                        : opacity > 0.0f)
            return true;
    }
    return false;
}

/// `shown` as integrate gives it, or empty.
void findVisible(TransferTable& table, const Optics& optics, const std::vector<bool>& shown) {
    table.visibleBefore.assign(TransferTable::entries + 1, 0);
    int first = TransferTable::entries, last = -1;
    for (int i = 0; i < TransferTable::entries; ++i) {
        // What is denser than something visible can be a ray's greatest value.
        const bool visible = canShow(table, optics, i) ||
                             (!shown.empty() && shown[std::size_t(i)]) ||
                             (optics.composition == Composition::maximumIntensity && last >= 0);
        table.visibleBefore[std::size_t(i) + 1] =
            table.visibleBefore[std::size_t(i)] + (visible ? 1 : 0);
        if (visible) first = std::min(first, i), last = i;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    table.visibleAboveHu = first == 0 ? -infinity : huOfEntry(table, first - 1);
    table.visibleBelowHu =
        last == TransferTable::entries - 1 ? infinity : huOfEntry(table, last + 1);
}

}  // namespace

bool TransferTable::anyVisible(double lowHu, double highHu) const {
    // A segment of nearly one value counts as an entry long, and sees what is beside it; a hair
    // more, as raycasters round.
    const double beside = integrals.empty() ? 0.0 : 0.51, lastEntry = entries - 1;
    const int low = int(std::clamp(std::floor(entryOf(lowHu) - beside), 0.0, lastEntry));
    const int high = int(std::clamp(std::ceil(entryOf(highHu) + beside), 0.0, lastEntry));
    const auto* before = visibleBefore.data();
    return before[high + 1] > before[low];
}

TransferTable makeTransferTable(const Optics& optics, double stepMm) {
    const TransferFunction& function = optics.transferFunction;
    const bool absorbs = optics.composition == Composition::emissionAbsorption;
    const double opacityExponent = absorbs ? stepMm : 1.0;
    TransferTable table;
    table.firstHu = function.points.front().hu;
    table.lastHu = function.points.back().hu;
    if (absorbs && !function.rows.empty()) {
        for (const GradientRow& row : function.rows) {
            table.firstHu = std::min(table.firstHu, row.points.front().hu);
            table.lastHu = std::max(table.lastHu, row.points.back().hu);
        }
        fillRows(table, function, opacityExponent);
    } else {
        table.rgba.resize(TransferTable::entries);
        fillRow(table, 0, function.points, function.points, 0.0, opacityExponent);
    }
    std::vector<bool> shown;
    if (absorbs && optics.preIntegrated) shown = integrate(table, function.points, stepMm);
    findVisible(table, optics, shown);
    return table;
}

}  // namespace haustra::render
