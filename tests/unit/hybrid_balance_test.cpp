// The hybrid raycaster's control loop against machines whose times are known.
#include "render/hybrid/balance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using render::HybridBalance;
using render::hybridLadder;

constexpr int last = int(hybridLadder.size()) - 1;

/// Each rung takes a fifth more of the CPU's time and a tenth less of the GPU's.
struct Machine {
    double cpuMs, gpuMs;                // on the lowest rung
    bool shared = false;                // the GPU is the CPU's own cores
    double cpuDelay = 0, gpuDelay = 0;  // injected
    double cpu(int rung) const { return cpuMs * std::pow(1.2, rung) + cpuDelay; }
    double gpu(int rung) const { return gpuMs * std::pow(0.9, rung) + gpuDelay; }
    double picture(int rung) const {
        return shared ? cpu(rung) + gpu(rung) : std::max(cpu(rung), gpu(rung));
    }
    int best() const {
        int best = 0;
        for (int rung = 0; rung <= last; ++rung)
            if (picture(rung) < picture(best)) best = rung;
        return best;
    }
};

std::vector<int> run(HybridBalance& balance, const Machine& machine, int pictures) {
    std::vector<int> rungs;
    for (int i = 0; i < pictures; ++i) {
        const int rung = balance.rung();
        balance.drew(machine.cpu(rung), machine.gpu(rung), machine.picture(rung));
        rungs.push_back(balance.rung());
    }
    return rungs;
}

TEST(HybridBalance, EachRungGivesTheCpuMoreToDo) {
    for (std::size_t i = 1; i < hybridLadder.size(); ++i) {
        const auto &low = hybridLadder[i - 1], &high = hybridLadder[i];
        EXPECT_FALSE(low == high);
        EXPECT_GE(low.entryLevel, high.entryLevel);
        EXPECT_LE(low.toBoundary, high.toBoundary);
        EXPECT_GE(low.leftToFilling, high.leftToFilling);
        if (low.exitLevel >= 0) {
            EXPECT_GE(low.exitLevel, high.exitLevel);
            EXPECT_GE(high.exitLevel, 0);
        }
    }
}

TEST(HybridBalance, GivesASlowGpuLessAndASlowCpuLess) {
    HybridBalance balance(4);
    run(balance, {2.0, 80.0}, 100);
    EXPECT_EQ(balance.rung(), last);
    HybridBalance other(4);
    run(other, {80.0, 2.0}, 100);
    EXPECT_EQ(other.rung(), 0);
}

TEST(HybridBalance, SettlesWherePicturesAreFastest) {
    for (const bool shared : {false, true}) {
        for (double ratio = 0.1; ratio < 3.0; ratio *= 1.13) {
            const Machine machine{20.0 * ratio, 20.0, shared};
            HybridBalance balance;
            const auto rungs = run(balance, machine, 200);
            for (int i = 100; i < 200; ++i)
                EXPECT_EQ(rungs[std::size_t(i)], rungs[199]) << "moves on at " << ratio;
            EXPECT_LE(machine.picture(balance.rung()), 1.1 * machine.picture(machine.best()))
                << ratio << (shared ? " shared" : "");
        }
    }
}

TEST(HybridBalance, FollowsDelaysThatComeAndGo) {
    const Machine even{10.0, 20.0};
    HybridBalance balance;
    run(balance, even, 100);
    const int before = balance.rung();
    Machine slow = even;
    slow.gpuDelay = 40.0;
    run(balance, slow, 100);
    EXPECT_GT(balance.rung(), before);
    run(balance, even, 100);
    EXPECT_NEAR(balance.rung(), before, 1);
    slow = even;
    slow.cpuDelay = 40.0;
    run(balance, slow, 100);
    EXPECT_LT(balance.rung(), before);
}

TEST(HybridBalance, NoiseOfAFifthDoesNotMoveItFromItsPlace) {
    HybridBalance balance;
    const Machine machine{10.0, 20.0};
    run(balance, machine, 100);
    const int settled = balance.rung();
    for (int i = 0; i < 400; ++i) {
        const double noise = i % 3 == 0 ? 1.2 : i % 3 == 1 ? 0.8 : 1.0;
        balance.drew(noise * machine.cpu(settled), machine.gpu(settled) / noise,
                     noise * machine.picture(settled));
        EXPECT_EQ(balance.rung(), settled);
    }
}

TEST(HybridBalance, TimesOfNothingAreNoReasonToMoveForEver) {
    HybridBalance balance;
    for (int i = 0; i < 50; ++i)
        balance.drew(0.0, 0.0, 0.0);
    const int settled = balance.rung();
    for (int i = 0; i < 50; ++i) {
        balance.drew(0.0, 0.0, 0.0);
        EXPECT_EQ(balance.rung(), settled);
    }
}

}  // namespace
}  // namespace haustra::tests
