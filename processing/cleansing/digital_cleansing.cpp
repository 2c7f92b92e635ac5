#include "cleansing/digital_cleansing.h"

#include "cleansing/ball.h"
#include "cleansing/rim_smoothing.h"
#include "cleansing/smooth_field.h"
#include "cleansing/untagged_fluid.h"
#include "core/connected_labels.h"
#include "core/ct_scan.h"
#include "core/flood_fill.h"
#include "core/tissue.h"
#include "core/volume.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace haustra::cleansing {
namespace {

/// One voxel that cleansing changed.
struct CleansedVoxel {
    std::uint32_t index;
    std::uint8_t tagged;  ///< share of residue taken out, in 255ths
    std::uint8_t air;     ///< share of air it held before, in 255ths
};

constexpr double speckMm3 = 12.0;

/// The 26-connected piece of wall around `seed`; empty where it has more than `most` voxels. Then
/// its voxels that were looked at are marked in `large`, and a piece that meets a marked voxel is
/// known to be as large.
std::vector<std::uint32_t> pieceOfWall(const Volume<std::uint8_t>& labels, std::uint32_t seed,
                                       std::size_t most, std::vector<bool>& large) {
    const Grid& grid = labels.grid();
    std::vector<std::uint32_t> piece{seed};
    bool whole = !large[seed];
    const auto neighbours = [&](std::uint32_t n, const auto& visit) {
        if (whole) visitCorners(grid, n, visit);
    };
    floodFill(piece, neighbours, [&](std::size_t n) {
        if (!whole || LumenLabel(labels[n]) != LumenLabel::outside ||
            std::find(piece.begin(), piece.end(), n) != piece.end())
            return false;
        whole = piece.size() < most && !large[n];
        return true;
    });
    if (whole) return piece;
    for (const std::uint32_t n : piece)
        large[n] = true;
    return {};
}

bool touchesLumen(const Volume<std::uint8_t>& labels, std::size_t index) {
    bool touches = false;
    visitFaces(labels.grid(), index, [&](std::size_t n, int) {
        touches = touches || LumenLabel(labels[n]) != LumenLabel::outside;
    });
    return touches;
}

/// LumenLabel by the cleansed scan. From `segmentation` goes what is wall now; to it come those of
/// `changed` (in memory order) that are air now and touch the lumen, unless they would join two
/// parts of it that `segmentation` keeps apart: a thin wall between them may be hidden by the
/// tagging's blur. Specks of less than 12 mm³ that float in the former residue are noise: they
/// become air in `hu`, and lumen. Bridges and untagged fluid stay.
Volume<std::uint8_t> refineLumen(Volume<std::int16_t>& hu, const TissueModel& tissue,
                                 const SmoothField& airHu, const Volume<std::uint8_t>& segmentation,
                                 std::span<const CleansedVoxel> changed) {
    Volume<std::uint8_t> labels = segmentation.clone();
    const auto out = labels.writable();
    const auto cleansed = hu.writable();
    const auto airAt = [&](std::size_t index) {
        const glm::ivec3 v = hu.grid().voxelAt(index);
        return airHu.at(v.x, v.y, v.z);
    };
    const auto labelOf = [](const CleansedVoxel& voxel) {
        return std::uint8_t(voxel.tagged > voxel.air ? LumenLabel::tagged : LumenLabel::air);
    };
    std::vector<const CleansedVoxel*> beside;
    for (const CleansedVoxel& voxel : changed) {
        const bool open = cleansed[voxel.index] < tissue.airBelowHu;
        if (out[voxel.index] == std::uint8_t(LumenLabel::outside)) {
            if (open) beside.push_back(&voxel);
        } else if (out[voxel.index] != std::uint8_t(LumenLabel::bridge) &&
                   out[voxel.index] != std::uint8_t(LumenLabel::untagged)) {
            out[voxel.index] = open ? labelOf(voxel) : std::uint8_t(LumenLabel::outside);
        }
    }
    // Each pass is one step outward.
    const glm::ivec3 steps = voxelsIn(hu.grid(), 1.5);
    for (int pass = 0; pass < std::max({steps.x, steps.y, steps.z}); ++pass) {
        std::vector<const CleansedVoxel*> touching, left;
        for (const CleansedVoxel* voxel : beside)
            (touchesLumen(labels, voxel->index) ? touching : left).push_back(voxel);
        for (const CleansedVoxel* voxel : touching) {
            if (joinsNothing(labels, voxel->index))
                out[voxel->index] = labelOf(*voxel);
            else
                left.push_back(voxel);
        }
        beside = std::move(left);
    }
    const std::size_t most =
        std::size_t(std::max(1.0, std::floor(speckMm3 / hu.grid().voxelVolumeMm3())));
    std::vector<bool> large(labels.grid().voxelCount(), false);  // an eighth of a byte each
    for (const CleansedVoxel& voxel : changed) {
        if (LumenLabel(out[voxel.index]) != LumenLabel::outside ||
            !touchesLumen(labels, voxel.index))
            continue;
        for (std::uint32_t n : pieceOfWall(labels, voxel.index, most, large)) {
            out[n] = std::uint8_t(LumenLabel::tagged);
            cleansed[n] = std::int16_t(std::lround(airAt(n)));
        }
    }
    return labels;
}

/// The share of the colon's own residue in each voxel of the surroundings. It falls from shell to
/// shell once it is not beside the tagging: where it rises again, another bowel or bone lies across
/// the wall.
template <class Mixture>
std::vector<std::vector<std::uint8_t>> residueShares(const TaggedSurroundings& around,
                                                     const Grid& grid, const Mixture& mixture) {
    constexpr int notRising = 25;  // in 255ths, for the noise
    std::vector<std::vector<std::uint8_t>> shares(around.shells.size());
    // Share and shell (from 1) of each voxel so far.
    Volume<std::uint8_t> shareAt(grid, std::uint8_t(0)), shellAt(grid, std::uint8_t(0));
    const auto share = shareAt.writable(), shellOf = shellAt.writable();
    for (std::size_t shell = 0; shell < around.shells.size(); ++shell) {
        for (std::uint32_t n : around.shells[shell]) {
            int tagged = mixture(n).tagged;
            if (int(shell) > around.besideShells && tagged > 0) {
                const glm::ivec3 v = grid.voxelAt(n);
                const glm::ivec3 lo = glm::max(v - 1, glm::ivec3(0)),
                                 hi = glm::min(v + 1, grid.size - 1);
                int most = 0;
                visitBox(lo, hi, [&](glm::ivec3 beside) {
                    const std::size_t m = grid.index(beside);
                    if (shellOf[m] == shell) most = std::max<int>(most, share[m]);
                });
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

/// CleansedLumen::lost.
std::vector<LostLumen> lostLumen(const Volume<std::uint8_t>& segmented,
                                 const Volume<std::uint8_t>& open) {
    constexpr double deepMm = 2.5, leastMl = 2.0;
    const Grid& grid = segmented.grid();
    const Ball ball(grid, glm::dvec3(deepMm));
    const auto isLumen = [&](std::size_t n) {
        return LumenLabel(segmented[n]) != LumenLabel::outside;
    };
    std::vector<bool> left(grid.voxelCount(), false);  // an eighth of a byte each
    std::vector<std::size_t> deep;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (LumenLabel(segmented[n]) != LumenLabel::tagged ||
            LumenLabel(open[n]) != LumenLabel::outside ||
            !ball.everywhere(grid.voxelAt(n), isLumen))
            continue;
        left[n] = true;
        deep.push_back(n);
    }
    std::vector<LostLumen> all;
    for (const std::size_t seed : deep) {
        if (!left[seed]) continue;
        left[seed] = false;
        std::vector<std::size_t> body{seed};
        floodFill(body, cornerNeighbours(grid), [&](std::size_t n) {
            const bool is = left[n];
            left[n] = false;
            return is;
        });
        const double ml = double(body.size()) * grid.voxelVolumeMm3() / 1000.0;
        if (ml < leastMl) continue;
        glm::dvec3 sum(0.0);
        for (const std::size_t n : body)
            sum += glm::dvec3(grid.voxelAt(n));
        all.push_back({grid.patientFromVoxelPoint(sum / double(body.size())), ml});
    }
    std::ranges::stable_sort(all, std::greater<>(), &LostLumen::ml);
    return all;
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
    auto part = TRY(cropToLumen(scan, segmentation, threads));
    if (!part) {
        Cleansed cleansed{scan.hu.clone(), segmentation.clone()};
        takeOutUntagged(cleansed.hu, cleansed.lumen, segmentation, tissue.meanHu[int(Tissue::air)],
                        threads);
        return cleansed;
    }
    CleansedLumen cleansed = cleanse(
        scan, tissue, mixture, measureTaggedLumen(std::move(*part), tissue, threads), threads);
    return Cleansed{std::move(cleansed.hu).whole(threads),
                    std::move(cleansed.lumen).whole(threads)};
}

CleansedLumen cleanse(const CtScan& scan, const TissueModel& tissue,
                      const Volume<TissueFractions>& wholeMixture, TaggedLumen lumen, int threads) {
    const Grid grid = lumen.scan.hu.grid();
    const TaggedSurroundings& around = lumen.around;
    const auto mixture = [&](std::size_t n) {
        return wholeMixture.at(grid.voxelAt(n) + lumen.box.lo);
    };
    const auto shares = residueShares(around, grid, mixture);
    std::vector<CleansedVoxel> changed;
    for (std::size_t shell = 0; shell < shares.size(); ++shell) {
        for (std::size_t m = 0; m < shares[shell].size(); ++m) {
            const std::uint32_t n = around.shells[shell][m];
            if (shares[shell][m] > 0 || shell == 0)
                changed.push_back({n, shares[shell][m], mixture(n).air});
        }
    }
    const auto byIndex = [](const CleansedVoxel& a, const CleansedVoxel& b) {
        return a.index < b.index;
    };
    std::sort(changed.begin(), changed.end(), byIndex);
    Volume<std::int16_t> hu = std::move(lumen.scan.hu);
    const auto out = hu.writable();
    const LocalMeans& means = lumen.means;
    parallelFor(changed.size(), 1 << 14, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t m = begin; m < end; ++m) {
            const CleansedVoxel& voxel = changed[m];
            const glm::ivec3 v = grid.voxelAt(voxel.index);
            const double contrast = means.taggedHu.at(v) - means.airHu.at(v.x, v.y, v.z);
            const double cleansed = out[voxel.index] - voxel.tagged / 255.0 * contrast;
            out[voxel.index] = std::int16_t(std::clamp(std::lround(cleansed), -1024L, 3071L));
        }
    });
    // Smoothing moves voxels that were not cleansed, too: these may have become wall or air as
    // well.
    const std::size_t cleansedVoxels = changed.size();
    for (const std::uint32_t n : smoothRim(hu, lumen.labels, tissue, around, threads)) {
        const CleansedVoxel voxel{n, 0, mixture(n).air};
        const auto sorted = std::span(changed).first(cleansedVoxels);
        if (!std::binary_search(sorted.begin(), sorted.end(), voxel, byIndex))
            changed.push_back(voxel);
    }
    std::inplace_merge(changed.begin(), changed.begin() + std::ptrdiff_t(cleansedVoxels),
                       changed.end(), byIndex);
    Volume<std::uint8_t> open = refineLumen(hu, tissue, means.airHu, lumen.labels, changed);
    // A narrow passage that was open in the segmentation stays open, though the cleansed wall may
    // look thick enough to close it.
    const auto segmented = [&](std::size_t n) {
        const bool isMeniscus =
            std::binary_search(lumen.menisci.begin(), lumen.menisci.end(), std::uint32_t(n));
        return isMeniscus ? std::uint8_t(LumenLabel::outside) : lumen.labels[n];
    };
    joinBodies(open, [&](std::size_t n) { return LumenLabel(segmented(n)) != LumenLabel::outside; },
               segmented, {.dropOthers = false});

    takeOutUntagged(hu, open, lumen.labels, tissue.meanHu[int(Tissue::air)], threads);

    CleansedLumen cleansed;
    cleansed.lost = lostLumen(lumen.labels, open);
    cleansed.hu = {lumen.scanGrid, lumen.box, std::move(hu), {}};
    cleansed.lumen = {lumen.scanGrid, lumen.box, std::move(open), {}};
    cleansed.hu.beyond = [enhancement = std::move(lumen.enhancement),
                          before = std::make_shared<const Volume<std::int16_t>>(scan.hu.share())](
                             glm::ivec3 first, std::span<std::int16_t> row) {
        std::copy_n(&before->voxels()[before->grid().index(first)], row.size(), row.begin());
        if (enhancement) enhancement.takeOff(first, row);
    };
    return cleansed;
}

}  // namespace haustra::cleansing
