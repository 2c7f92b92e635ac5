#include "cleansing/digital_cleansing.h"

#include "cleansing/local_means.h"
#include "cleansing/menisci.h"
#include "cleansing/pseudo_enhancement.h"
#include "cleansing/refined_lumen.h"
#include "cleansing/rim_smoothing.h"
#include "cleansing/tagged_surroundings.h"
#include "core/connected_labels.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace haustra::cleansing {
namespace {

/// The share of the colon's own residue in each voxel of the surroundings. It falls from shell to
/// shell once it is not beside the tagging: where it rises again, another bowel or bone lies across
/// the wall.
std::vector<std::vector<std::uint8_t>> residueShares(const TaggedSurroundings& around,
                                                     const Volume<TissueFractions>& mixture) {
    constexpr int notRising = 25;  // in 255ths, for the noise
    const Grid& grid = mixture.grid();
    std::vector<std::vector<std::uint8_t>> shares(around.shells.size());
    // Share and shell (from 1) of each voxel so far.
    std::vector<std::uint8_t> share(grid.voxelCount(), 0), shellOf(grid.voxelCount(), 0);
    for (std::size_t shell = 0; shell < around.shells.size(); ++shell) {
        for (std::uint32_t n : around.shells[shell]) {
            int tagged = mixture[n].tagged;
            if (int(shell) > around.besideShells && tagged > 0) {
                const glm::ivec3 v = grid.voxelAt(n);
                const glm::ivec3 lo = glm::max(v - 1, glm::ivec3(0)),
                                 hi = glm::min(v + 1, grid.size - 1);
                int most = 0;
                for (int k = lo.z; k <= hi.z; ++k) {
                    for (int j = lo.y; j <= hi.y; ++j) {
                        for (int i = lo.x; i <= hi.x; ++i) {
                            const std::size_t m = grid.index(i, j, k);
                            if (shellOf[m] == shell) most = std::max<int>(most, share[m]);
                        }
                    }
                }
                tagged = tagged > most + notRising ? 0 : std::min(tagged, most);
            }
            shares[shell].push_back(std::uint8_t(tagged));
        }
        for (std::size_t m = 0; m < around.shells[shell].size(); ++m) {
            share[around.shells[shell][m]] = shares[shell][m];
            shellOf[around.shells[shell][m]] = std::uint8_t(shell + 1);
        }
    }
    return shares;
}

}  // namespace

Result<Cleansed> cleanse(const CtScan& scan, const TissueModel& tissue,
                         const Volume<TissueFractions>& mixture,
                         const Volume<std::uint8_t>& segmentation, int threads) {
    const Grid& grid = scan.hu.grid();
    if (!sameGrid(grid, segmentation.grid()) || !sameGrid(grid, mixture.grid())) {
        return fail(ErrorKind::badInput, "the mixture or segmentation is not on the scan's grid",
                    "cleansing");
    }
    if (grid.voxelCount() > std::numeric_limits<std::uint32_t>::max()) {
        return fail(ErrorKind::unsupported, "the scan has more than 2^32 voxels", "cleansing");
    }
    const Volume<std::uint8_t> labels = withMenisci(scan, tissue, segmentation);
    const TaggedSurroundings around = taggedSurroundings(labels, threads);
    if (around.shells[0].empty()) return Cleansed{scan.hu.clone(), segmentation.clone()};
    const PseudoEnhancement enhancement = measurePseudoEnhancement(scan, tissue, labels, threads);
    const CtScan corrected =
        enhancement ? withoutPseudoEnhancement(scan, enhancement, threads) : CtScan{};
    const CtScan& seen = enhancement ? corrected : scan;
    Cleansed cleansed{seen.hu.clone(), {}};
    const LocalMeans means = measureLocalMeans(seen, tissue, labels, around, threads);
    const auto shares = residueShares(around, mixture);
    std::vector<CleansedVoxel> changed;
    for (std::size_t shell = 0; shell < shares.size(); ++shell) {
        for (std::size_t m = 0; m < shares[shell].size(); ++m) {
            const std::uint32_t n = around.shells[shell][m];
            if (shares[shell][m] > 0 || shell == 0)
                changed.push_back({n, shares[shell][m], mixture[n].air});
        }
    }
    const auto byIndex = [](const CleansedVoxel& a, const CleansedVoxel& b) {
        return a.index < b.index;
    };
    std::sort(changed.begin(), changed.end(), byIndex);
    const auto out = cleansed.hu.writable();
    parallelFor(changed.size(), 1 << 14, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t m = begin; m < end; ++m) {
            const CleansedVoxel& voxel = changed[m];
            const glm::ivec3 v = grid.voxelAt(voxel.index);
            const double contrast = means.taggedHu.at(v) - means.airHu.at(v.x, v.y, v.z);
            const double hu = seen.hu[voxel.index] - voxel.tagged / 255.0 * contrast;
            out[voxel.index] = std::int16_t(std::clamp(std::lround(hu), -1024L, 3071L));
        }
    });
    // What the smoothing moves beside them may be wall, or air, from now on as well.
    const std::size_t cleansedVoxels = changed.size();
    for (const std::uint32_t n : smoothRim(cleansed.hu, labels, tissue, around, threads)) {
        const CleansedVoxel voxel{n, 0, mixture[n].air};
        const auto sorted = std::span(changed).first(cleansedVoxels);
        if (!std::binary_search(sorted.begin(), sorted.end(), voxel, byIndex))
            changed.push_back(voxel);
    }
    std::inplace_merge(changed.begin(), changed.begin() + std::ptrdiff_t(cleansedVoxels),
                       changed.end(), byIndex);
    cleansed.lumen = refineLumen(cleansed.hu, tissue, means.airHu, labels, changed);
    // The way on through a narrow place is no less there because its wall looks thicker now.
    joinBodies(
        cleansed.lumen,
        [&](std::size_t n) { return LumenLabel(segmentation[n]) != LumenLabel::outside; },
        [&](std::size_t n) { return segmentation[n]; }, {.dropOthers = false});
    return cleansed;
}

}  // namespace haustra::cleansing
