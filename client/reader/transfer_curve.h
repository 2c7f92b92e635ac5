// The points of a transfer function, or of one of its gradient rows, while a hand changes them.
#pragma once

#include "core/optics.h"

#include <cstddef>
#include <vector>

namespace haustra::reader {

/// Points sorted by HU, two at least, as checkTransferFunction has them: whatever is called, they
/// stay so. Colour and opacity are linear between them.
class TransferCurve {
public:
    /// Black and clear from −1000 to 1000 HU.
    TransferCurve();
    /// `points` as checkTransferFunction passes them.
    explicit TransferCurve(std::vector<TransferFunctionPoint> points);

    const std::vector<TransferFunctionPoint>& points() const { return points_; }
    /// As the curve has it there.
    TransferFunctionPoint at(double hu) const;
    /// A point more, of the curve's colour there; returns its number. Beyond mostTransferPoints
    /// none is added, and the nearest is returned.
    std::size_t add(double hu, double opacity);
    /// No farther than to its neighbours.
    void move(std::size_t point, double hu, double opacity);
    void setColor(std::size_t point, glm::dvec3 color);
    /// False, and nothing done, where too little would be left.
    bool remove(std::size_t point);

private:
    std::vector<TransferFunctionPoint> points_;
};

}  // namespace haustra::reader
