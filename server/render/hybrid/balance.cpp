#include "render/hybrid/balance.h"

#include <algorithm>
#include <cstddef>

namespace haustra::render {

void HybridBalance::drew(double cpuMs, double gpuMs) {
    sum_.cpuMs += cpuMs;
    sum_.gpuMs += gpuMs;
    if (++pictures_ < patience) return;
    const Seen here{sum_.cpuMs / patience, sum_.gpuMs / patience};
    pictures_ = 0;
    sum_ = {};
    const double ratio = std::max(here.cpuMs, 1e-3) / std::max(here.gpuMs, 1e-3);
    if (settled_ > 0.0 && ratio < settled_ * stirring && ratio > settled_ / stirring) return;
    settled_ = 0.0;
    const int wanted = ratio > tolerance ? rung_ - 1 : ratio < 1.0 / tolerance ? rung_ + 1 : rung_;
    const int next = std::clamp(wanted, 0, int(hybridLadder.size()) - 1);
    if (next == rung_) {
        settled_ = ratio;
        cameFrom_ = -1;
        return;
    }
    if (next != cameFrom_) {
        moveTo(next, here);
        return;
    }
    // The balance lies between the two.
    if (here.longer() <= there_.longer()) {
        settled_ = ratio;
        cameFrom_ = -1;
        return;
    }
    settled_ = std::max(there_.cpuMs, 1e-3) / std::max(there_.gpuMs, 1e-3);
    rung_ = next;
    cameFrom_ = -1;
}

void HybridBalance::moveTo(int rung, Seen from) {
    cameFrom_ = rung_;
    there_ = from;
    rung_ = rung;
}

}  // namespace haustra::render
