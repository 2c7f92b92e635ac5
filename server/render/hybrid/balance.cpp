#include "render/hybrid/balance.h"

#include <algorithm>

namespace haustra::render {

double HybridBalance::Seen::ratio() const {
    return std::max(cpuMs, 1e-3) / std::max(gpuMs, 1e-3);
}

void HybridBalance::drew(double cpuMs, double gpuMs, double pictureMs) {
    sum_.cpuMs += cpuMs / patience;
    sum_.gpuMs += gpuMs / patience;
    sum_.pictureMs += pictureMs / patience;
    if (++pictures_ < patience) return;
    const Seen here = sum_;
    pictures_ = 0;
    sum_ = {};
    const double ratio = here.ratio();
    if (settled_ > 0.0 && ratio < settled_ * stirring && ratio > settled_ / stirring) return;
    settled_ = 0.0;
    if (cameFrom_ < 0) {
        step(ratio < 1.0 / tolerance ? 1 : -1, here);
    } else if (here.pictureMs <= there_.pictureMs * (1.0 - gain)) {
        step(rung_ - cameFrom_, here);
    } else {
        settled_ = there_.ratio();
        rung_ = cameFrom_;
        cameFrom_ = -1;
    }
}

void HybridBalance::step(int direction, const Seen& here) {
    const int next = rung_ + direction;
    if (next < 0 || next >= int(hybridLadder.size())) {
        settled_ = here.ratio();
        cameFrom_ = -1;
        return;
    }
    cameFrom_ = rung_;
    there_ = here;
    rung_ = next;
}

}  // namespace haustra::render
