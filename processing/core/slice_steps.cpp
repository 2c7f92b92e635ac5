#include "core/slice_steps.h"

#include "core/parallel.h"
#include "core/printed_text.h"
#include "core/quantile.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace haustra {
namespace {

// Between each slice and the next.
std::vector<double> stepsHu(const Volume<std::int16_t>& hu, int threads) {
    constexpr int lowestHu = -1024, highestHu = 600;
    const Grid& grid = hu.grid();
    const std::size_t perSlice = std::size_t(grid.size.x) * std::size_t(grid.size.y);
    std::vector<double> steps(std::size_t(std::max(0, grid.size.z - 1)), 0.0);
    parallelFor(steps.size(), 4, threads, [&](std::size_t first, std::size_t last) {
        const auto clamped = [&](std::size_t n) {
            return std::clamp(int(hu[n]), lowestHu, highestHu);
        };
        for (std::size_t k = first; k < last; ++k) {
            long long sum = 0;
            for (std::size_t n = k * perSlice; n < (k + 1) * perSlice; ++n)
                sum += std::abs(clamped(n) - clamped(n + perSlice));
            steps[k] = double(sum) / double(perSlice);
        }
    });
    return steps;
}

double medianAround(const std::vector<double>& steps, std::size_t k) {
    constexpr std::size_t reach = 5;
    std::vector<double> around(
        steps.begin() + std::ptrdiff_t(k - std::min(k, reach)),
        steps.begin() + std::ptrdiff_t(std::min(k + reach + 1, steps.size())));
    return medianOf(around);
}

}  // namespace

std::optional<std::string> unevenStepsOf(const Volume<std::int16_t>& hu, int threads) {
    constexpr double farMore = 2.5;
    // What differs by less than any scanner's noise is drawn, and may be as it likes.
    constexpr double leastHu = 2.0;
    const std::vector<double> steps = stepsHu(hu, threads);
    std::size_t uneven = 0, same = 0, widest = 0, firstSame = 0;
    double widestRatio = 0.0;
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const double usual = medianAround(steps, k);
        if (usual < leastHu) continue;
        if (steps[k] == 0.0 && same++ == 0) firstSame = k;
        const double ratio = steps[k] / usual;
        if (ratio < farMore) continue;
        ++uneven;
        if (ratio > widestRatio) widestRatio = ratio, widest = k;
    }
    const auto heightMm = [&](std::size_t k) {
        const glm::dvec2 middle = 0.5 * glm::dvec2(glm::ivec2(hu.grid().size) - 1);
        return hu.grid().patientFromVoxelPoint({middle, double(k)}).z;
    };
    std::string told;
    if (uneven > 0) {
        told = printed("the slices at %.1f and %.1f mm differ %.1f times as much as those around",
                       heightMm(widest), heightMm(widest + 1), widestRatio);
        if (uneven > 1)
            told += printed(uneven > 2 ? ", and %zu more pairs by %.1f times and more"
                                       : ", and %zu more pair by %.1f times and more",
                            uneven - 1, farMore);
        told += ": the patient breathed or moved between them, or slices do not belong there";
    }
    if (same > 0)
        told += (told.empty() ? "" : "; ") +
                printed(same > 1 ? "%zu slices are the same as the one before, the first at %.1f mm"
                                 : "%zu slice is the same as the one before, the first at %.1f mm",
                        same, heightMm(firstSame + 1));
    if (told.empty()) return std::nullopt;
    return told;
}

}  // namespace haustra
