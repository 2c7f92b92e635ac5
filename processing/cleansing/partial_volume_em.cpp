#include "cleansing/partial_volume_em.h"

#include "cleansing/hu_histogram.h"

#include <array>
#include <cmath>

namespace haustra::cleansing {
namespace {

constexpr int binHu = 4;  // finer than any noise
constexpr int binCount = (highestHu - lowestHu + 1) / binHu;
using Histogram = std::vector<double>;

Histogram binned(const std::vector<double>& byHu) {
    Histogram histogram(binCount, 0.0);
    for (std::size_t n = 0; n < byHu.size(); ++n)
        histogram[n / binHu] += byHu[n];
    return histogram;
}

// One thing a voxel can be: `share` of tissue `a`, the rest of tissue `b`.
struct Blend {
    int a, b;
    double share;
    int kind;  // what its weight is shared with: a pure tissue, or all shares of one pair
};

constexpr int kindCount = tissueCount + 4;

std::vector<Blend> blends() {
    constexpr int air = int(Tissue::air), fat = int(Tissue::fat), soft = int(Tissue::soft),
                  tagged = int(Tissue::taggedOrBone);
    constexpr std::array<std::array<int, 2>, 4> pairs = {
        {{air, fat}, {air, soft}, {fat, soft}, {soft, tagged}}};
    constexpr int shares = 24;
    std::vector<Blend> all;
    for (int t = 0; t < tissueCount; ++t)
        all.push_back({t, t, 1.0, t});
    for (int p = 0; p < int(pairs.size()); ++p) {
        for (int n = 0; n < shares; ++n)
            all.push_back({pairs[std::size_t(p)][0], pairs[std::size_t(p)][1], (n + 0.5) / shares,
                           tissueCount + p});
    }
    return all;
}

// Every blend's part in each HU, by the present means, variances and weights.
class Evidence {
public:
    Evidence(const std::vector<Blend>& all, const TissueModel& model,
             const std::array<double, kindCount>& weight) {
        std::array<int, kindCount> members{};
        for (const Blend& blend : all)
            ++members[std::size_t(blend.kind)];
        for (const Blend& b : all) {
            const double sa = model.sdHu[std::size_t(b.a)], sb = model.sdHu[std::size_t(b.b)];
            const double variance = b.share * sa * sa + (1.0 - b.share) * sb * sb;
            mean.push_back(b.share * model.meanHu[std::size_t(b.a)] +
                           (1.0 - b.share) * model.meanHu[std::size_t(b.b)]);
            inverseVariance.push_back(1.0 / variance);
            scale.push_back(weight[std::size_t(b.kind)] / members[std::size_t(b.kind)] /
                            std::sqrt(2.0 * M_PI * variance));
        }
    }

    /// Fills `part` with the posterior of each blend at `hu`; false where none explains it.
    bool posterior(double hu, std::vector<double>& part) const {
        part.resize(mean.size());
        double sum = 0.0;
        for (std::size_t n = 0; n < mean.size(); ++n) {
            const double d = hu - mean[n], exponent = 0.5 * d * d * inverseVariance[n];
            part[n] = exponent > 40.0 ? 0.0 : scale[n] * std::exp(-exponent);
            sum += part[n];
        }
        if (sum < 1e-12) return false;
        for (double& p : part)
            p /= sum;
        return true;
    }

    std::vector<double> mean, inverseVariance, scale;
};

/// Fits `model` and the kinds' weights, and returns the weights.
std::array<double, kindCount> fit(const Histogram& histogram, const std::vector<Blend>& all,
                                  TissueModel& model) {
    constexpr double smallestSd = 6.0;
    constexpr std::array<double, tissueCount> largestSd = {60.0, 60.0, 60.0, 250.0};
    // No calibrated scanner moves a mean farther than this from the whole-voxel fit.
    constexpr std::array<double, tissueCount> largestStep = {40.0, 40.0, 40.0, 200.0};
    const TissueModel start = model;
    std::array<double, kindCount> weight;
    weight.fill(1.0 / kindCount);
    std::vector<double> part;
    for (int iteration = 0; iteration < 40; ++iteration) {
        const Evidence evidence(all, model, weight);
        std::array<double, tissueCount> held{}, sum{}, square{}, mass{};
        std::array<double, kindCount> kindMass{};
        double total = 0.0;
        for (int bin = 0; bin < binCount; ++bin) {
            const double count = histogram[std::size_t(bin)];
            const double hu = lowestHu + (bin + 0.5) * binHu - 0.5;
            if (count == 0.0 || !evidence.posterior(hu, part)) continue;
            total += count;
            for (std::size_t n = 0; n < all.size(); ++n) {
                const double r = count * part[n];
                if (r < 1e-9) continue;
                kindMass[std::size_t(all[n].kind)] += r;
                // E[x_k | y] = m μ_k + m σ_k² (y − Σ m μ) / Σ m σ²; likewise its variance.
                const double rest = (hu - evidence.mean[n]) * evidence.inverseVariance[n];
                const bool pure = all[n].a == all[n].b;
                for (int side = 0; side < (pure ? 1 : 2); ++side) {
                    const std::size_t t = std::size_t(side ? all[n].b : all[n].a);
                    const double m = pure ? 1.0 : side ? 1.0 - all[n].share : all[n].share;
                    const double s2 = model.sdHu[t] * model.sdHu[t];
                    const double deviation = m * s2 * rest;
                    const double variance = m * s2 * (1.0 - m * s2 * evidence.inverseVariance[n]);
                    held[t] += r * m;
                    sum[t] += r * (m * model.meanHu[t] + deviation);
                    square[t] += r * (deviation * deviation + variance) / m;
                    mass[t] += r;
                }
            }
        }
        if (total == 0.0) break;
        double change = 0.0;
        for (std::size_t t = 0; t < tissueCount; ++t) {
            if (held[t] < 1e-7 * total) continue;
            const double mean = std::clamp(sum[t] / held[t], start.meanHu[t] - largestStep[t],
                                           start.meanHu[t] + largestStep[t]);
            change = std::max(change, std::abs(mean - model.meanHu[t]));
            model.meanHu[t] = mean;
            model.sdHu[t] = std::clamp(std::sqrt(square[t] / mass[t]), smallestSd, largestSd[t]);
            model.weight[t] = held[t] / total;
        }
        for (std::size_t k = 0; k < kindCount; ++k)
            weight[k] = std::max(kindMass[k] / total, 1e-7);
        if (change < 0.05) break;
    }
    return weight;
}

}  // namespace

PartialVolumeModel fitPartialVolume(const CtScan& scan, const TissueModel& start, int threads) {
    PartialVolumeModel result;
    result.tissue = start;
    const std::vector<Blend> all = blends();
    const auto weight = fit(binned(huHistogram(scan, threads)), all, result.tissue);
    const Evidence evidence(all, result.tissue, weight);
    std::vector<double> part;
    for (int hu = lowestHu; hu <= highestHu; ++hu) {
        double air = 0.0, tagged = 0.0;
        if (hu < result.tissue.meanHu[int(Tissue::air)]) {
            air = 1.0;  // colder than air: noise
        } else if (hu > result.tissue.meanHu[int(Tissue::taggedOrBone)]) {
            tagged = 1.0;
        } else if (evidence.posterior(hu, part)) {
            for (std::size_t n = 0; n < all.size(); ++n) {
                if (all[n].a == int(Tissue::air)) air += part[n] * all[n].share;
                if (all[n].b == int(Tissue::taggedOrBone)) tagged += part[n] * (1.0 - all[n].share);
                if (all[n].a == int(Tissue::taggedOrBone)) tagged += part[n];
            }
        }
        result.fractions.push_back(roundedFractions(std::min(air, 1.0), std::min(tagged, 1.0)));
    }
    return result;
}

}  // namespace haustra::cleansing
