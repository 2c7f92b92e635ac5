#include "segmentation/edge_overshoot.h"

#include "core/printed_text.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>
#include <utility>

namespace haustra::segmentation {
namespace {

constexpr double besideMm = 2.0, rimMm = 2.5;
constexpr int leastVoxels = 2;
constexpr int lowestHu = -1024, highestHu = 3071;

bool isGas(std::uint8_t content) {
    return Content(content) == Content::gas;
}

/// Peaks of HU in the two millimetres beyond gas on one side, or two voxels, sorted.
std::vector<std::int16_t> peaksBeside(const Volume<std::int16_t>& hu,
                                      const Volume<std::uint8_t>& content, int axis, int sign,
                                      const std::vector<std::uint32_t>& border) {
    const Grid& grid = hu.grid();
    const int reach = std::max(leastVoxels, int(std::lround(besideMm / grid.spacingMm()[axis])));
    std::vector<std::int16_t> peaks;
    for (const std::uint32_t n : border) {
        glm::ivec3 v = grid.voxelAt(n);
        int most = lowestHu;
        for (int step = 0; step < reach; ++step) {
            v[axis] += sign;
            if (!grid.contains(v) || isGas(content.at(v))) break;
            most = std::max<int>(most, hu.at(v));
        }
        if (most > lowestHu) peaks.push_back(std::int16_t(std::min(most, highestHu)));
    }
    std::sort(peaks.begin(), peaks.end());
    return peaks;
}

/// Voxels of gas that touch something else.
std::vector<std::uint32_t> borderOfGas(const Volume<std::uint8_t>& content, int threads) {
    const Grid& grid = content.grid();
    return voxelsWhere(grid, threads, [&](std::size_t n, glm::ivec3 v) {
        bool border = false;
        if (isGas(content[n]))
            visitFaces(grid, n, v,
                       [&](std::size_t m, int) { border = border || !isGas(content[m]); });
        return border;
    });
}

}  // namespace

double overshootBesideGasHu(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& content,
                            const TissueModel& tissue, int threads) {
    constexpr double mostBrighter = 0.05, oneSd = 0.8413, sds = 2.5;
    constexpr std::size_t leastPeaks = 500;
    const std::vector<std::uint32_t> border = borderOfGas(content, threads);
    double least = highestHu;
    for (const auto& [axis, sign] :
         std::array<std::pair<int, int>, 4>{{{0, -1}, {0, 1}, {1, -1}, {1, 1}}}) {
        const std::vector<std::int16_t> peaks = peaksBeside(hu, content, axis, sign, border);
        if (peaks.size() < leastPeaks) return 0.0;
        const auto quantile = [&](double share) {
            return double(peaks[std::size_t(share * double(peaks.size() - 1))]);
        };
        if (quantile(1.0 - mostBrighter) <= tissue.taggedAboveHu) return 0.0;
        least = std::min(least, quantile(0.5) + sds * (quantile(oneSd) - quantile(0.5)));
    }
    const double softHu = tissue.meanHu[int(Tissue::soft)];
    return softHu + 2.0 * (least - softHu);
}

void takeOffOvershoot(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                      BowelContents& contents, int threads) {
    const double overshootHu = overshootBesideGasHu(hu, contents.content, tissue, threads);
    if (overshootHu <= tissue.taggedAboveHu) return;
    const Grid& grid = hu.grid();
    const auto voxels = contents.content.writable();
    const glm::dvec3 spacing = grid.spacingMm();
    const glm::ivec3 reach(rimMm / spacing);
    const auto visitRim = [&](glm::ivec3 v, const auto& visit) {
        const glm::ivec3 lo = glm::max(v - reach, glm::ivec3(0)),
                         hi = glm::min(v + reach, grid.size - 1);
        visitBox(lo, hi, [&](glm::ivec3 w) {
            if (glm::length(spacing * glm::dvec3(w - v)) <= rimMm) visit(grid.index(w));
        });
    };
    std::unordered_set<std::size_t> underLevels;
    for (const Level& level : contents.levels) {
        for (const LevelColumn& column : level.columns)
            visitRim(column.below, [&](std::size_t n) { underLevels.insert(n); });
    }
    for (const std::uint32_t n : borderOfGas(contents.content, threads)) {
        visitRim(grid.voxelAt(n), [&](std::size_t m) {
            if (Content(voxels[m]) == Content::tagged && hu[m] <= overshootHu &&
                underLevels.count(m) == 0)
                voxels[m] = std::uint8_t(Content::tissue);
        });
    }
    contents.warnings.push_back(printed(
        "the kernel is sharp: the wall beside gas is up to %.0f HU bright, as tagged material "
        "is; thin residue on it is not seen, and detection may miss polyps, the more the sharper",
        overshootHu));
}

}  // namespace haustra::segmentation
