#include "core/scan_coarseness.h"

#include "core/printed_text.h"

#include <algorithm>
#include <cmath>

namespace haustra {
namespace {

// What rounds to a limit keeps it.
constexpr double roundingMm = 0.05;

double widestStepMm(const Grid& grid, const SourceSeries* series) {
    const glm::dvec3 spacing = grid.spacingMm();
    double widest = std::max({spacing.x, spacing.y, spacing.z});
    if (!series) return widest;
    const glm::dvec3 normal = glm::cross(series->rowDirection, series->columnDirection);
    const auto& images = series->images;
    for (std::size_t n = 1; n < images.size(); ++n) {
        const glm::dvec3 step = images[n].positionMm - images[n - 1].positionMm;
        widest = std::max(widest, std::abs(glm::dot(step, normal)));
    }
    return widest;
}

double thickestSliceMm(const SourceSeries* series) {
    double thickest = 0.0;
    if (series)
        for (const SourceImage& image : series->images)
            thickest = std::max(thickest, image.thicknessMm);
    return thickest;
}

}  // namespace

std::optional<std::string> coarsenessOf(const Grid& grid, const SourceSeries* series) {
    const double apart = widestStepMm(grid, series), thick = thickestSliceMm(series);
    std::string found;
    if (apart > widestReadableStepMm + roundingMm)
        found = printed("samples up to %.3g mm apart (CT colonography needs %.3g at most)", apart,
                        widestReadableStepMm);
    if (thick > thickestReadableSliceMm + roundingMm)
        found += printed("%sslices %.3g mm thick (%.3g at most)", found.empty() ? "" : " and ",
                         thick, thickestReadableSliceMm);
    if (found.empty()) return std::nullopt;
    constexpr double much = 1.5;
    const bool large =
        apart > much * widestReadableStepMm || thick > much * thickestReadableSliceMm;
    return "the scan has " + found +
           (large ? ": polyps may not show in it, large ones among them"
                  : ": small and flat polyps may not show in it");
}

}  // namespace haustra
