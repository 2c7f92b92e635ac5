// The balance between CPU and GPU on machines whose costs are known, with noise.
#include "render/hybrid/balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using render::HybridBalance;
using render::hybridSplits;

constexpr int splits = int(hybridSplits.size()), last = splits - 1;
using Curve = std::array<double, splits>;

struct NamedCurve {
    const char* name;
    Curve ms;
};

/// What a picture costs on each split.
const std::vector<NamedCurve> curves = {
    {"flat", {50, 50, 50, 50, 50, 50, 50, 50, 50}},
    {"rises", {50, 55, 62, 70, 80, 90, 105, 120, 140}},
    {"falls", {140, 120, 105, 90, 80, 70, 62, 55, 50}},
    {"one valley", {100, 88, 76, 65, 55, 63, 72, 84, 95}},
    {"a cliff and a plateau", {121, 390, 400, 403, 398, 380, 340, 310, 300}},
    {"a valley behind a ridge", {100, 140, 150, 140, 80, 75, 120, 170, 160}},
    {"three valleys", {80, 120, 70, 130, 160, 60, 110, 120, 90}},
    {"best at the far end of a plateau", {100, 101, 99, 100, 102, 100, 99, 101, 70}},
};

double best(const Curve& ms) {
    return *std::min_element(ms.begin(), ms.end());
}

/// Pictures on one machine: each takes up to `spread` more or less, and one in twenty takes up to
/// thrice as long where `spikes`.
class Machine {
public:
    Machine(double spread, bool spikes, unsigned seed)
        : spread_(spread), spikes_(spikes), random_(seed) {}

    double noise() {
        const auto unit = [&] { return double(random_()) / double(random_.max()); };
        double factor = std::exp(spread_ * (2.0 * unit() - 1.0));
        if (spikes_ && unit() < 0.05) factor *= 1.0 + 2.0 * unit();
        return factor;
    }

    /// Of each picture, what its split and the best one cost without noise.
    struct Drawn {
        double ms, bestMs;
    };
    std::vector<Drawn> run(HybridBalance& balance, const Curve& ms, int pictures,
                           double cpuPerGpu = 1.0) {
        std::vector<Drawn> drawn;
        for (int i = 0; i < pictures; ++i) {
            const double cost = ms[std::size_t(balance.split())];
            drawn.push_back({cost, ms[std::size_t(balance.best())]});
            const double cpuMs = cost * cpuPerGpu / (1.0 + cpuPerGpu);
            balance.drew(cpuMs * noise(), (cost - cpuMs) * noise(), cost * noise());
        }
        return drawn;
    }

private:
    double spread_;
    bool spikes_;
    std::mt19937 random_;
};

struct Noise {
    double spread;
    bool spikes;
};
constexpr Noise noises[] = {{0.0, false}, {0.05, false}, {0.1, true}, {0.25, true}};

/// Calls body(curve, noise, seed, what this is).
template <class Body>
void forAll(Body&& body) {
    for (const NamedCurve& curve : curves)
        for (const Noise& noise : noises)
            for (unsigned seed = 0; seed < 12; ++seed)
                body(curve.ms, noise, seed,
                     std::string(curve.name) + ", noise " + std::to_string(noise.spread) +
                         ", seed " + std::to_string(seed));
}

TEST(HybridBalance, EachSplitGivesTheCpuMoreToDo) {
    for (std::size_t i = 1; i < hybridSplits.size(); ++i) {
        const auto &low = hybridSplits[i - 1], &high = hybridSplits[i];
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

TEST(HybridBalance, FindsTheBestSplitOfAnyCurve) {
    forAll([](const Curve& ms, const Noise& noise, unsigned seed, const std::string& what) {
        HybridBalance balance;
        Machine machine(noise.spread, noise.spikes, seed);
        machine.run(balance, ms, 1500);
        double mean = 0.0;
        for (const auto& drawn : machine.run(balance, ms, 1500))
            mean += drawn.bestMs / 1500;
        EXPECT_LE(mean, (1.04 + 0.3 * noise.spread) * best(ms)) << what;
    });
}

TEST(HybridBalance, StaysWithNoSplitThatIsWorseThanTheFirst) {
    forAll([](const Curve& ms, const Noise& noise, unsigned seed, const std::string& what) {
        HybridBalance balance;
        Machine machine(noise.spread, noise.spikes, seed);
        int worse = 0, together = 0, longest = 0;
        for (const auto& drawn : machine.run(balance, ms, 4000)) {
            const bool here = drawn.bestMs > (1.03 + noise.spread) * ms[0];
            worse += here;
            together = here ? together + 1 : 0;
            longest = std::max(longest, together);
        }
        // Luck may lead there, but nothing stays.
        EXPECT_LE(worse, 80) << what;
        EXPECT_LE(longest, 80) << what;
    });
}

TEST(HybridBalance, TrialsCostLittle) {
    forAll([](const Curve& ms, const Noise& noise, unsigned seed, const std::string& what) {
        HybridBalance balance;
        Machine machine(noise.spread, noise.spikes, seed);
        double lost = 0.0;
        int pictures = 0;
        for (const auto& drawn : machine.run(balance, ms, 3000)) {
            lost += std::max(drawn.ms / drawn.bestMs - 1.0, 0.0);
            const double oneTrial = 4.0;
            EXPECT_LE(lost, (1.0 + noise.spread) * (HybridBalance::costPerPicture * ++pictures +
                                                    HybridBalance::mostCredit + oneTrial))
                << what << " after " << pictures;
        }
    });
}

TEST(HybridBalance, FindsItsPlaceAnewWhereTheCurveChanges) {
    for (const double cpuPerGpu : {1.0, 4.0}) {  // which the times tell, or do not
        for (const NamedCurve& before : curves) {
            forAll(
                [&](const Curve& ms, const Noise& noise, unsigned seed, const std::string& what) {
                    if (seed > 1) return;
                    HybridBalance balance;
                    Machine machine(noise.spread, noise.spikes, seed);
                    machine.run(balance, before.ms, 1000);
                    machine.run(balance, ms, 600, cpuPerGpu);
                    // Soon as good as the lowest, and in time as good as the best.
                    double mean = 0.0;
                    for (const auto& drawn : machine.run(balance, ms, 400, cpuPerGpu))
                        mean += drawn.bestMs / 400;
                    EXPECT_LE(mean, (1.03 + noise.spread) * ms[0]) << before.name << " to " << what;
                    machine.run(balance, ms, 1000, cpuPerGpu);
                    mean = 0.0;
                    for (const auto& drawn : machine.run(balance, ms, 500, cpuPerGpu))
                        mean += drawn.bestMs / 500;
                    EXPECT_LE(mean, (1.05 + 0.4 * noise.spread) * best(ms))
                        << before.name << " to " << what;
                });
        }
    }
}

TEST(HybridBalance, AChangeThatTheTimesTellIsSoonFollowed) {
    int late = 0, all = 0;
    for (const NamedCurve& before : curves) {
        forAll([&](const Curve& ms, const Noise& noise, unsigned seed, const std::string&) {
            if (seed > 1) return;
            HybridBalance balance;
            Machine machine(noise.spread, noise.spikes, seed);
            machine.run(balance, before.ms, 1000);
            machine.run(balance, ms, 60, 4.0);
            late += ms[std::size_t(balance.best())] > (1.05 + noise.spread) * ms[0];
            ++all;
        });
    }
    EXPECT_LE(late, all / 20);
}

TEST(HybridBalance, GivesASlowGpuLessAndASlowCpuLess) {
    // Each split takes a fifth more of the CPU's time and a tenth less of the GPU's.
    const auto standsOn = [](double cpuMs, double gpuMs) {
        HybridBalance balance;
        for (int i = 0; i < 400; ++i) {
            const double cpu = cpuMs * std::pow(1.2, balance.split()),
                         gpu = gpuMs * std::pow(0.9, balance.split());
            balance.drew(cpu, gpu, std::max(cpu, gpu));
        }
        return balance.best();
    };
    EXPECT_EQ(standsOn(2.0, 80.0), last);
    EXPECT_EQ(standsOn(80.0, 2.0), 0);
    EXPECT_NEAR(standsOn(10.0, 20.0), std::log(2.0) / std::log(1.2 / 0.9), 1.0);
}

TEST(HybridBalance, ViewsThatCostMoreAndMoreMisleadNobody) {
    // As on a flight from an open lumen to a narrow one and back, ever again.
    for (const NamedCurve& curve : curves) {
        HybridBalance balance;
        Machine machine(0.05, false, 3);
        double mean = 0.0, pictures = 0.0;
        for (int i = 0; i < 4000; ++i) {
            const double view = std::exp(std::sin(0.02 * i));
            const double ms = curve.ms[std::size_t(balance.split())];
            if (i > 1500) {
                mean += curve.ms[std::size_t(balance.best())];
                ++pictures;
            }
            balance.drew(0.5 * ms * view, 0.5 * ms * view, ms * view * machine.noise());
        }
        EXPECT_LE(mean / pictures, 1.06 * best(curve.ms)) << curve.name;
    }
}

TEST(HybridBalance, NothingFromElsewhereIsCompared) {
    // A picture here and one elsewhere that costs a tenth, in turns: a split that was tried here
    // would look ten times as good there.
    HybridBalance balance;
    for (int i = 0; i < 500; ++i) {
        balance.elsewhere();
        balance.drew(1.0, 1.0, i % 2 == 0 ? 100.0 : 10.0);
        EXPECT_EQ(balance.best(), 0);
    }
}

TEST(HybridBalance, TimesOfNothingAreNoReasonToMove) {
    HybridBalance balance;
    for (int i = 0; i < 200; ++i) {
        balance.drew(0.0, 0.0, 0.0);
        EXPECT_EQ(balance.best(), 0);
    }
}

}  // namespace
}  // namespace haustra::tests
