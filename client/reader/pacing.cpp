#include "reader/pacing.h"

#include <array>

namespace haustra::reader {

ViewPacer::Ask ViewPacer::next(bool changed, Time now) {
    if (changed || touched_) {
        dirty_ = true;
        stillAsked_ = false;
        changedAt_ = now;
        touched_ = false;
    }
    if (dirty_ && now - askedAt_ >= interval_) {
        dirty_ = false;
        askedAt_ = now;
        return Ask::moving;
    }
    if (!stillAsked_ && now - changedAt_ >= restAfter_) {
        dirty_ = false;
        stillAsked_ = true;
        askedAt_ = now;
        return Ask::still;
    }
    return Ask::nothing;
}

namespace {
constexpr std::array<double, 5> scales = {1.0, 0.75, 0.55, 0.4, 0.3};
}

double MovingDetail::scale() const {
    return scales[std::size_t(step_)];
}

bool MovingDetail::add(double latencyMs) {
    slow_ = latencyMs > slowMs ? slow_ + 1 : 0;
    fast_ = latencyMs < fastMs ? fast_ + 1 : 0;
    const bool down = slow_ >= picturesPerStep && step_ + 1 < int(scales.size());
    // Going up costs more pixels: be slower to believe it than going down.
    const bool up = fast_ >= 5 * picturesPerStep && step_ > 0;
    if (!down && !up) return false;
    step_ += down ? 1 : -1;
    slow_ = fast_ = 0;
    return true;
}

}  // namespace haustra::reader
