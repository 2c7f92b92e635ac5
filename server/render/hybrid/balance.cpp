#include "render/hybrid/balance.h"

#include <algorithm>
#include <cmath>

namespace haustra::render {

namespace {

/// Home's pictures before another rung is asked.
constexpr int fewestHome = 3;
/// Pictures from doubt to doubt.
constexpr long doubtEvery = 64;

}  // namespace

void HybridBalance::Few::add(double value) {
    if (count() > mostPairs) values_.erase(values_.begin());
    values_.push_back(value);
}

double HybridBalance::Few::median() const {
    std::vector<double> sorted = values_;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t n = sorted.size();
    return 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
}

void HybridBalance::drew(double cpuMs, double gpuMs, double pictureMs) {
    ++pictures_;
    // Times of nothing tell nothing, and divide nothing.
    const double ms = std::max(pictureMs, 1e-3);
    if (guestsTurn_)
        drewGuest(ms);
    else
        drewHome(std::max(cpuMs, 1e-3), std::max(gpuMs, 1e-3), ms);
}

void HybridBalance::elsewhere() {
    guest_ = -1;
    guestsTurn_ = false;
    homeMs_.clear();
    cpuPerGpu_.clear();
}

void HybridBalance::drewHome(double cpuMs, double gpuMs, double pictureMs) {
    homeMs_.add(pictureMs);
    cpuPerGpu_.add(cpuMs / gpuMs);
    credit_ = std::min(credit_ + share, mostCredit);
    if (guest_ >= 0) {
        judge();
        guestsTurn_ = guest_ >= 0;
        return;
    }
    if (homeMs_.count() < fewestHome) return;
    doubt();
    if (rest_ > 0) --rest_;
    if (rest_ > 0 || credit_ <= 0.0) return;
    guest_ = nextGuest();
    guestsTurn_ = true;
    guestMs_.clear();
}

void HybridBalance::drewGuest(double pictureMs) {
    const double ratio = pictureMs / homeMs_.median();
    credit_ -= std::max(ratio - 1.0, 0.0);
    if (guestMs_.count() == 0) {
        if (ratio > hopeless) return endAsking(false, ratio);
        // Of home's pictures, only those drawn in turns with the guest's are compared with them.
        homeMs_.clear();
    }
    guestMs_.add(pictureMs);
    guestsTurn_ = false;
}

void HybridBalance::judge() {
    const int pairs = guestMs_.count();
    const double ratio = guestMs_.median() / homeMs_.median();
    const bool apart = guestMs_.most() < homeMs_.least();
    if (pairs >= pairsToLose && ratio > worse)
        endAsking(false, ratio);
    else if (pairs == mostPairs || (pairs >= pairsToWin && apart))
        endAsking(ratio < 1.0 - gain, ratio);
}

void HybridBalance::endAsking(bool won, double ratio) {
    asked_[std::size_t(guest_)] = {true, pictures_, ratio - 1.0};
    if (won) {
        asked_[std::size_t(home_)] = {true, pictures_, 0.0};
        for (Asked& one : asked_)
            one.excess = (1.0 + one.excess) / ratio - 1.0;
        home_ = guest_;
        homeMs_ = guestMs_;
        cpuPerGpu_.clear();
        knownCpuPerGpu_ = 0.0;
        nextRest_ = shortestRest;
        rest_ = 0;
    } else {
        // Until all were asked once there is no reason to wait but what it costs.
        bool all = true;
        for (int rung = 0; rung < rungs; ++rung)
            all = all && (rung == home_ || asked_[std::size_t(rung)].ever);
        rest_ = all ? nextRest_ : 0;
        if (all) nextRest_ = std::min(2 * nextRest_, longestRest);
    }
    guest_ = -1;
    guestsTurn_ = false;
}

void HybridBalance::doubt() {
    const double ratio = cpuPerGpu_.count() < fewestHome ? 0.0 : cpuPerGpu_.median();
    if (ratio == 0.0) return;
    if (knownCpuPerGpu_ == 0.0) knownCpuPerGpu_ = ratio;
    if (ratio < knownCpuPerGpu_ * stirring && ratio > knownCpuPerGpu_ / stirring) return;
    if (pictures_ - doubtedAt_ < doubtEvery) return;
    doubtedAt_ = pictures_;
    knownCpuPerGpu_ = ratio;
    for (Asked& one : asked_)
        one.excess = 0.0;
    asked_[0].ever = false;
    rest_ = 0;
    nextRest_ = shortestRest;
}

int HybridBalance::nextGuest() const {
    const bool down = cpuPerGpu_.count() > 0 && cpuPerGpu_.median() > tolerance;
    int best = -1;
    double bestWaited = -1.0;
    const auto consider = [&](int rung) {
        if (rung < 0 || rung >= rungs || rung == home_) return;
        const Asked& one = asked_[std::size_t(rung)];
        const bool close = rung == 0 || std::abs(rung - home_) == 1;
        const double slow = close ? 0.25 : std::clamp(one.excess, 0.25, 1.0);
        const double waited = one.ever ? double(pictures_ - one.at) / slow : HUGE_VAL;
        if (waited <= bestWaited) return;
        best = rung;
        bestWaited = waited;
    };
    consider(0);
    for (const int side : {down ? -1 : 1, down ? 1 : -1})
        for (int away = 1; away < rungs; ++away)
            consider(home_ + side * away);
    return best;
}

}  // namespace haustra::render
