// A transfer function while a hand changes it.
#pragma once

#include "panels/case_info.h"

#include <cstddef>
#include <vector>

namespace haustra::panels {

/// Points sorted by HU, two at least. Colour and opacity are linear between them.
class TransferCurve {
public:
    static constexpr double minHu = -1024.0, maxHu = 3071.0;
    static constexpr std::size_t maxPoints = 64;

    /// The colon's wall, opaque, as a start.
    TransferCurve();

    const std::vector<TransferPoint>& points() const { return points_; }
    /// As the curve has it there.
    TransferPoint at(double hu) const;
    /// A point more, of the curve's colour there; returns its number. At most maxPoints: none is
    /// added beyond, and the nearest is returned.
    std::size_t add(double hu, double opacity);
    /// No farther than to its neighbours.
    void move(std::size_t point, double hu, double opacity);
    void setColor(std::size_t point, glm::dvec3 color);
    /// False, and nothing done, where only two are left.
    bool remove(std::size_t point);

private:
    std::vector<TransferPoint> points_;
};

}  // namespace haustra::panels
