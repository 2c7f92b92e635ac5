#include "cleansing/tissue_mixture.h"

#include "cleansing/hu_histogram.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace haustra::cleansing {
namespace {

constexpr int huCount = highestHu - lowestHu + 1;
using Histogram = std::vector<double>;

double countIn(const Histogram& histogram, int fromHu, int toHu) {
    return std::accumulate(histogram.begin() + (fromHu - lowestHu),
                           histogram.begin() + (toHu - lowestHu), 0.0);
}

double startingMean(const Histogram& histogram, HuRange range) {
    // The mode of a histogram smoothed over ±20 HU, so that quantised scans have one too.
    double best = -1.0, mode = 0.5 * (range.fromHu + range.toHu);
    for (int hu = range.fromHu; hu < range.toHu; ++hu) {
        const double count =
            countIn(histogram, std::max(lowestHu, hu - 20), std::min(highestHu, hu + 20));
        if (count > best) best = count, mode = hu;
    }
    return mode;
}

double gaussian(double hu, double mean, double sd) {
    const double z = (hu - mean) / sd;
    return std::exp(-0.5 * z * z) / (sd * std::sqrt(2.0 * M_PI));
}

// Expectation and maximisation on the histogram. A uniform background takes what belongs to no
// class: partial-volume voxels, lung, metal.
void fit(const Histogram& histogram, const TissuePriors& priors, TissueModel& model) {
    constexpr double smallestSd = 6.0;
    constexpr std::array<double, tissueCount> largestSd = {60.0, 60.0, 60.0, 250.0};
    double background = 0.1;
    const double uniform = 1.0 / huCount;
    std::array<double, tissueCount> previous{};
    for (int iteration = 0; iteration < 200; ++iteration) {
        std::array<double, tissueCount> mass{}, sum{}, square{};
        double total = 0.0, backgroundMass = 0.0;
        for (int bin = 0; bin < huCount; ++bin) {
            if (histogram[bin] == 0.0) continue;
            const double hu = lowestHu + bin;
            std::array<double, tissueCount> share;
            double evidence = background * uniform;
            for (int t = 0; t < tissueCount; ++t) {
                share[t] = model.weight[t] * gaussian(hu, model.meanHu[t], model.sdHu[t]);
                evidence += share[t];
            }
            for (int t = 0; t < tissueCount; ++t) {
                const double r = histogram[bin] * share[t] / evidence;
                mass[t] += r, sum[t] += r * hu, square[t] += r * hu * hu;
            }
            backgroundMass += histogram[bin] * background * uniform / evidence;
            total += histogram[bin];
        }
        double change = 0.0;
        for (int t = 0; t < tissueCount; ++t) {
            if (mass[t] > 1e-9 * total) {
                const double mean = sum[t] / mass[t];
                const double variance = square[t] / mass[t] - mean * mean;
                model.meanHu[t] =
                    std::clamp<double>(mean, priors.meanHu[t].fromHu, priors.meanHu[t].toHu);
                model.sdHu[t] =
                    std::clamp(std::sqrt(std::max(variance, 0.0)), smallestSd, largestSd[t]);
            }
            model.weight[t] = std::max(mass[t] / total, 1e-9);
            change = std::max(change, std::abs(model.meanHu[t] - previous[t]));
            previous[t] = model.meanHu[t];
        }
        background = std::max(backgroundMass / total, 1e-6);
        if (change < 0.01) break;
    }
}

}  // namespace

Result<TissueModel> fitTissueModel(const CtScan& scan, int threads, const TissuePriors& priors) {
    const Histogram histogram = huHistogram(scan, threads);
    const double all = countIn(histogram, lowestHu, highestHu);
    const HuRange airRange = priors.meanHu[int(Tissue::air)],
                  softRange = priors.meanHu[int(Tissue::soft)];
    const double air = countIn(histogram, lowestHu, airRange.toHu),
                 soft = countIn(histogram, softRange.fromHu, softRange.toHu);
    // Padding (−1024 and less) is not counted; a scan padded with exactly −1024 still shows bowel
    // gas.
    if (air < 1e-4 * std::max(all, 1.0)) {
        const auto isAny = [](double count) { return count > 0.0; };
        const int low = lowestHu + int(std::ranges::find_if(histogram, isAny) - histogram.begin()),
                  high = lowestHu + int(histogram.size()) - 1 -
                         int(std::find_if(histogram.rbegin(), histogram.rend(), isAny) -
                             histogram.rbegin());
        return fail(
            ErrorKind::noResult,
            "the scan holds no air (nothing below " + std::to_string(airRange.toHu) + " HU; its " +
                (all > 0.0
                     ? "values go from " + std::to_string(low) + " to " + std::to_string(high) +
                           ": where they are no HU, as stored values without their rescaling "
                           "or a window's greys, export the series anew)"
                     : std::string("values are all padding's)")),
            "tissue model");
    }
    if (soft < 1e-3 * std::max(all, 1.0)) {
        return fail(ErrorKind::noResult,
                    "the scan holds no soft tissue (nothing from " +
                        std::to_string(softRange.fromHu) + " to " + std::to_string(softRange.toHu) +
                        " HU)",
                    "tissue model");
    }
    TissueModel model;
    for (int t = 0; t < tissueCount; ++t) {
        model.meanHu[t] = startingMean(histogram, priors.meanHu[t]);
        model.sdHu[t] = 30.0;
        model.weight[t] = 0.9 / tissueCount;
    }
    // Bone and tagging are broad and have no mode worth the name: their mean over the range.
    const HuRange dense = priors.meanHu[int(Tissue::taggedOrBone)];
    double mass = 0.0, sum = 0.0;
    for (int hu = dense.fromHu; hu < dense.toHu; ++hu) {
        mass += histogram[hu - lowestHu], sum += histogram[hu - lowestHu] * hu;
    }
    if (mass > 0.0) model.meanHu[int(Tissue::taggedOrBone)] = sum / mass;
    model.sdHu[int(Tissue::taggedOrBone)] = 150.0;
    fit(histogram, priors, model);
    const double softMean = model.meanHu[int(Tissue::soft)], softSd = model.sdHu[int(Tissue::soft)];
    model.airBelowHu = 0.5 * (model.meanHu[int(Tissue::air)] + softMean);
    // Midway, but no lower than soft tissue's noise and no higher than weak tagging.
    const double midway = 0.5 * (softMean + model.meanHu[int(Tissue::taggedOrBone)]);
    const double lowest = softMean + std::max(70.0, 2.5 * softSd);
    model.taggedAboveHu = std::clamp(midway, lowest, std::max(lowest, softMean + 160.0));
    return model;
}

}  // namespace haustra::cleansing
