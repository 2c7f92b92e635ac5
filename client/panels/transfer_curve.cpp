#include "panels/transfer_curve.h"

#include <algorithm>
#include <cmath>

namespace haustra::panels {

TransferCurve::TransferCurve()
    : points_{{-750.0, {0.86, 0.49, 0.42}, 0.0},
              {-550.0, {0.93, 0.59, 0.51}, 0.97},
              {-350.0, {0.96, 0.67, 0.58}, 1.0},
              {50.0, {0.90, 0.50, 0.44}, 1.0},
              {250.0, {0.98, 0.91, 0.78}, 1.0}} {}

TransferPoint TransferCurve::at(double hu) const {
    const auto after =
        std::find_if(points_.begin(), points_.end(), [&](const auto& p) { return p.hu > hu; });
    TransferPoint here = after == points_.begin() ? points_.front() : *(after - 1);
    if (after != points_.begin() && after != points_.end()) {
        const double share = (hu - here.hu) / (after->hu - here.hu);
        here.color = glm::mix(here.color, after->color, share);
        here.opacity += share * (after->opacity - here.opacity);
    }
    here.hu = hu;
    return here;
}

std::size_t TransferCurve::add(double hu, double opacity) {
    TransferPoint point = at(std::clamp(hu, minHu, maxHu));
    point.opacity = std::clamp(opacity, 0.0, 1.0);
    const auto after = std::find_if(points_.begin(), points_.end(),
                                    [&](const auto& p) { return p.hu > point.hu; });
    const auto index = std::size_t(after - points_.begin());
    if (points_.size() >= maxPoints) return std::min(index, points_.size() - 1);
    points_.insert(after, point);
    return index;
}

void TransferCurve::move(std::size_t point, double hu, double opacity) {
    // A step of a HU stays between points, so that the curve is one value everywhere.
    const double low = point > 0 ? points_[point - 1].hu + 1.0 : minHu;
    const double high = point + 1 < points_.size() ? points_[point + 1].hu - 1.0 : maxHu;
    if (std::isfinite(hu) && low <= high) points_[point].hu = std::clamp(hu, low, high);
    if (std::isfinite(opacity)) points_[point].opacity = std::clamp(opacity, 0.0, 1.0);
}

void TransferCurve::setColor(std::size_t point, glm::dvec3 color) {
    points_[point].color = glm::clamp(color, 0.0, 1.0);
}

bool TransferCurve::remove(std::size_t point) {
    if (points_.size() <= 2) return false;
    points_.erase(points_.begin() + std::ptrdiff_t(point));
    return true;
}

}  // namespace haustra::panels
