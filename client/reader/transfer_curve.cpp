#include "reader/transfer_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::reader {
namespace {

constexpr double leastSpanHu = 1.0;  // from the first point to the last

}  // namespace

TransferCurve::TransferCurve()
    : points_{{-1000.0, glm::dvec3(0.0), 0.0}, {1000.0, glm::dvec3(0.0), 0.0}} {}

TransferCurve::TransferCurve(std::vector<TransferFunctionPoint> points)
    : points_(std::move(points)) {}

TransferFunctionPoint TransferCurve::at(double hu) const {
    TransferFunctionPoint here = pointAt(points_, hu);
    here.hu = hu;
    return here;
}

std::size_t TransferCurve::add(double hu, double opacity) {
    TransferFunctionPoint point = at(std::clamp(hu, lowestTransferHu, highestTransferHu));
    point.opacity = std::clamp(opacity, 0.0, 1.0);
    const auto after = std::find_if(points_.begin(), points_.end(),
                                    [&](const auto& p) { return p.hu > point.hu; });
    const auto index = std::size_t(after - points_.begin());
    if (points_.size() >= mostTransferPoints) return std::min(index, points_.size() - 1);
    points_.insert(after, point);
    return index;
}

void TransferCurve::move(std::size_t point, double hu, double opacity) {
    const std::size_t last = points_.size() - 1;
    double low = point > 0 ? points_[point - 1].hu : lowestTransferHu;
    double high = point < last ? points_[point + 1].hu : highestTransferHu;
    if (point == 0) high = std::min(high, points_[last].hu - leastSpanHu);
    if (point == last) low = std::max(low, points_[0].hu + leastSpanHu);
    if (std::isfinite(hu) && low <= high) points_[point].hu = std::clamp(hu, low, high);
    if (std::isfinite(opacity)) points_[point].opacity = std::clamp(opacity, 0.0, 1.0);
}

void TransferCurve::setColor(std::size_t point, glm::dvec3 color) {
    points_[point].color = glm::clamp(color, 0.0, 1.0);
}

bool TransferCurve::remove(std::size_t point) {
    if (points_.size() <= 2) return false;
    const double first = points_[point == 0 ? 1 : 0].hu,
                 last = points_[point + 1 == points_.size() ? point - 1 : points_.size() - 1].hu;
    if (last - first < leastSpanHu) return false;
    points_.erase(points_.begin() + std::ptrdiff_t(point));
    return true;
}

}  // namespace haustra::reader
