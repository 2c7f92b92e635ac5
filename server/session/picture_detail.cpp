#include "session/picture_detail.h"

#include <algorithm>
#include <cmath>

namespace haustra::session {
namespace {

constexpr int leastSide = 16;
constexpr double finerShare = 0.8;  // of movingPictureMs

glm::ivec2 scaled(glm::ivec2 full, double scale) {
    const auto side = [&](int pixels) {
        return std::clamp(int(std::lround(pixels * scale)), std::min(pixels, leastSide), pixels);
    };
    return {side(full.x), side(full.y)};
}

}  // namespace

void PictureDetail::drawn(double ms, glm::ivec2 size) {
    std::rotate(recent_.begin(), recent_.end() - 1, recent_.end());
    recent_.front() = ms / (double(size.x) * double(size.y));
    count_ = std::min(count_ + 1, recent_.size());
}

double PictureDetail::msPerPixel() const {
    if (count_ == 0) return 0.0;
    std::vector<double> sorted(recent_.begin(), recent_.begin() + std::ptrdiff_t(count_));
    std::sort(sorted.begin(), sorted.end());
    return sorted[count_ / 2];
}

glm::ivec2 PictureDetail::nextSize(glm::ivec2 full, double share) {
    const double fullMs = msPerPixel() * double(full.x) * double(full.y) / share;
    const std::size_t before = step_;
    for (step_ = 0; step_ + 1 < detailSteps.size(); ++step_) {
        const double ms = fullMs * detailSteps[step_] * detailSteps[step_];
        if (ms <= movingPictureMs * (step_ < before ? finerShare : 1.0)) break;
    }
    return scaled(full, detailSteps[step_]);
}

}  // namespace haustra::session
