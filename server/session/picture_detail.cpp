#include "session/picture_detail.h"

#include <algorithm>
#include <cmath>

namespace haustra::session {
namespace {

constexpr double finerShare = 0.8;  // of movingPictureMs

}  // namespace

glm::ivec2 coarseSize(glm::ivec2 full, double scale) {
    const int fullShorter = std::min(full.x, full.y), fullLonger = std::max(full.x, full.y);
    const int shorter = std::clamp(int(std::lround(fullShorter * scale)),
                                   std::min(fullShorter, leastSide), fullShorter);
    // Not rounded from the scale: one side follows the other.
    const int longer = int(std::lround(double(fullLonger) * shorter / fullShorter));
    return full.x < full.y ? glm::ivec2(shorter, longer) : glm::ivec2(longer, shorter);
}

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
    const double msOfPixel = msPerPixel() / share;
    const std::size_t before = step_;
    for (step_ = 0; step_ + 1 < detailSteps.size(); ++step_) {
        const glm::dvec2 size = coarseSize(full, detailSteps[step_]);
        if (msOfPixel * size.x * size.y <= movingPictureMs * (step_ < before ? finerShare : 1.0))
            break;
    }
    return coarseSize(full, detailSteps[step_]);
}

}  // namespace haustra::session
