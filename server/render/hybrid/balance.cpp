#include "render/hybrid/balance.h"

#include <algorithm>
#include <cmath>

namespace haustra::render {

namespace {

/// Pictures of the best split before another one is tried.
constexpr int fewestOfBest = 3;
/// Fewest pictures from one forgetting of old trials to the next.
constexpr long distrustEvery = 64;

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
    if (candidatesTurn_)
        drewCandidate(ms);
    else
        drewBest(std::max(cpuMs, 1e-3), std::max(gpuMs, 1e-3), ms);
}

void HybridBalance::elsewhere() {
    candidate_ = -1;
    candidatesTurn_ = false;
    bestMs_.clear();
    cpuPerGpu_.clear();
}

void HybridBalance::drewBest(double cpuMs, double gpuMs, double pictureMs) {
    bestMs_.add(pictureMs);
    cpuPerGpu_.add(cpuMs / gpuMs);
    credit_ = std::min(credit_ + costPerPicture, mostCredit);
    if (candidate_ >= 0) {
        judge();
        candidatesTurn_ = candidate_ >= 0;
        return;
    }
    if (bestMs_.count() < fewestOfBest) return;
    distrustTrials();
    if (pause_ > 0) --pause_;
    if (pause_ > 0 || credit_ <= 0.0) return;
    candidate_ = nextCandidate();
    candidatesTurn_ = true;
    candidateMs_.clear();
}

void HybridBalance::drewCandidate(double pictureMs) {
    const double ratio = pictureMs / bestMs_.median();
    credit_ -= std::max(ratio - 1.0, 0.0);
    if (candidateMs_.count() == 0) {
        if (ratio > hopeless) return endTrial(false, ratio);
        // Of the best one's pictures, only those drawn in turns with the candidate's are compared
        // with them.
        bestMs_.clear();
    }
    candidateMs_.add(pictureMs);
    candidatesTurn_ = false;
}

void HybridBalance::judge() {
    const int pairs = candidateMs_.count();
    const double ratio = candidateMs_.median() / bestMs_.median();
    const bool apart = candidateMs_.most() < bestMs_.least();
    if (pairs >= pairsToLose && ratio > worse)
        endTrial(false, ratio);
    else if (pairs == mostPairs || (pairs >= pairsToWin && apart))
        endTrial(ratio < 1.0 - gain, ratio);
}

void HybridBalance::endTrial(bool won, double ratio) {
    trials_[std::size_t(candidate_)] = {true, pictures_, ratio - 1.0};
    if (won) {
        trials_[std::size_t(best_)] = {true, pictures_, 0.0};
        for (Trial& one : trials_)
            one.excess = (1.0 + one.excess) / ratio - 1.0;
        best_ = candidate_;
        bestMs_ = candidateMs_;
        cpuPerGpu_.clear();
        knownCpuPerGpu_ = 0.0;
        nextPause_ = shortestPause;
        pause_ = 0;
    } else {
        // Until all were tried once there is no reason to wait but what it costs.
        bool all = true;
        for (int split = 0; split < splits; ++split)
            all = all && (split == best_ || trials_[std::size_t(split)].ever);
        pause_ = all ? nextPause_ : 0;
        if (all) nextPause_ = std::min(2 * nextPause_, longestPause);
    }
    candidate_ = -1;
    candidatesTurn_ = false;
}

void HybridBalance::distrustTrials() {
    const double ratio = cpuPerGpu_.count() < fewestOfBest ? 0.0 : cpuPerGpu_.median();
    if (ratio == 0.0) return;
    if (knownCpuPerGpu_ == 0.0) knownCpuPerGpu_ = ratio;
    if (ratio < knownCpuPerGpu_ * mostChange && ratio > knownCpuPerGpu_ / mostChange) return;
    if (pictures_ - distrustedAt_ < distrustEvery) return;
    distrustedAt_ = pictures_;
    knownCpuPerGpu_ = ratio;
    for (Trial& one : trials_)
        one.excess = 0.0;
    trials_[0].ever = false;
    pause_ = 0;
    nextPause_ = shortestPause;
}

int HybridBalance::nextCandidate() const {
    const bool down = cpuPerGpu_.count() > 0 && cpuPerGpu_.median() > tolerance;
    int best = -1;
    double bestWaited = -1.0;
    const auto consider = [&](int split) {
        if (split < 0 || split >= splits || split == best_) return;
        const Trial& one = trials_[std::size_t(split)];
        const bool close = split == 0 || std::abs(split - best_) == 1;
        const double slow = close ? 0.25 : std::clamp(one.excess, 0.25, 1.0);
        const double waited = one.ever ? double(pictures_ - one.at) / slow : HUGE_VAL;
        if (waited <= bestWaited) return;
        best = split;
        bestWaited = waited;
    };
    consider(0);
    for (const int side : {down ? -1 : 1, down ? 1 : -1})
        for (int away = 1; away < splits; ++away)
            consider(best_ + side * away);
    return best;
}

}  // namespace haustra::render
