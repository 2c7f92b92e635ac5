#include "cleansing/mixture.h"

#include "cleansing/ball.h"
#include "cleansing/interface_layer.h"
#include "cleansing/level_rim.h"
#include "cleansing/local_means.h"
#include "cleansing/submerged_mixture.h"
#include "cleansing/thin_films.h"
#include "cleansing/water_level.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace haustra::cleansing {
namespace {

/// The fractions of one voxel in or beside the tagged lumen.
class ColonMixture {
public:
    ColonMixture(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                 const LocalMeans& means, const InterfaceLayer& interfaces, const WaterLevel& level)
        : hu_(scan.hu),
          segmentation_(segmentation),
          means_(means),
          interfaces_(interfaces),
          level_(level),
          look_(neighbourStep(scan.hu.grid())),
          levelMm_(glm::dot(glm::abs(glm::dvec3(level.down())), scan.hu.grid().spacingMm())),
          levelBlurMm_(interfaces.spread().acrossMm(glm::dvec3(level.down()))) {}

    TissueFractions at(std::size_t index) const {
        const Grid& grid = hu_.grid();
        const glm::ivec3 v = grid.voxelAt(index);
        const double y = hu_[index];
        const double airHu = means_.airHu.at(v.x, v.y, v.z),
                     softHu = means_.softHu.at(v.x, v.y, v.z);
        const double taggedHu = std::max<double>(means_.taggedHu.at(v.x, v.y, v.z), softHu + 60.0);
        // Two tissues at most, by the side of soft tissue's HU that the voxel lies on.
        double air = std::clamp((softHu - y) / (softHu - airHu), 0.0, 1.0);
        double tagged = std::clamp((y - softHu) / (taggedHu - softHu), 0.0, 1.0);
        const Neighbours around = look(v, softHu, taggedHu);
        if (!around.tagged && y > softHu) return roundedFractions(0.0, 0.0);
        // As sure as the noise lets the tagging be told from the wall.
        const double noise = means_.noise.tagged / (taggedHu - softHu);
        if (around.meanShare > 1.0 - std::max(0.1, 0.8 * noise) &&
            around.leastShare > 1.0 - std::max(0.5, 4.0 * noise))
            return roundedFractions(0.0, 1.0);
        if (!around.tagged) tagged = 0.0;
        const InterfaceLayer::Crossing crossing = interfaces_.crossing(v, taggedHu, softHu);
        // Fluid does not stand beside air: under a level, a slanted step hides a wall.
        const double bare = !crossing.level && level_.standsAbove(crossing.tagged, segmentation_)
                                ? 0.0
                                : crossing.bareness;
        if (bare < 0.95 && aboveFluid(v, softHu, taggedHu) && besideWall(v, softHu, taggedHu)) {
            if (const auto three = atLevel(v, softHu, taggedHu)) return *three;
        }
        if (bare > 0.0) {
            const double share = std::clamp((y - airHu) / (taggedHu - airHu), 0.0, 1.0);
            air = glm::mix(air, 1.0 - share, bare), tagged = glm::mix(tagged, share, bare);
        }
        return roundedFractions(air, tagged);
    }

private:
    struct Neighbours {
        bool tagged = false;     ///< some are more tagged than soft
        double meanShare = 0.0;  ///< of tagged material, over the 27 voxels
        double leastShare = 1.0;
    };

    /// Where the level meets the wall all three tissues may share a voxel. The level tells how much
    /// of the contents is fluid, and so the HU the voxel would have without the wall; the rest is
    /// wall. Where that HU is soft tissue's own, the voxels above and below tell its share.
    std::optional<TissueFractions> atLevel(glm::ivec3 v, double softHu, double taggedHu) const {
        const auto depth = level_.depthMm(v);
        if (!depth || std::abs(*depth) > 2.5 * levelBlurMm_) return std::nullopt;
        const glm::ivec3 down = level_.down();
        const double airHu = means_.airHu.at(v.x, v.y, v.z);
        const auto fluidAt = [&](double depthMm) {
            return 0.5 * std::erfc(-depthMm / (levelBlurMm_ * std::sqrt(2.0)));
        };
        double sum = 0.0, weight = 1e-9;
        const auto add = [&](int step) {
            const glm::ivec3 n = v + step * down;
            if (!hu_.grid().contains(n)) return;
            const double open = airHu + fluidAt(*depth + step * levelMm_) * (taggedHu - airHu);
            // A row counts by the contrast of wall in it, squared, as the noise is the same in all;
            // rows farther off count so little that they decide only where this one has no
            // contrast.
            const double certainty = (softHu - open) / (softHu - airHu);
            const double w =
                certainty * certainty * (step == 0 ? 1.0 : 0.015 / (std::abs(step) * levelMm_));
            sum += w *
                   std::clamp((hu_.at(n) - open) / (softHu - open + (softHu > open ? 1e-3 : -1e-3)),
                              0.0, 1.0);
            weight += w;
        };
        const int rows = std::max(1, int(std::lround(1.5 / levelMm_)));
        for (int step = -rows; step <= rows; ++step)
            add(step);
        // Where the voxel's HU cannot come of this level, the level is that of another pool.
        const double open = airHu + fluidAt(*depth) * (taggedHu - airHu), y = hu_.at(v);
        const double slack = 4.0 * means_.noise.tagged +
                             0.3 * fluidAt(*depth) * (1.0 - fluidAt(*depth)) * (taggedHu - airHu);
        if (y < std::min(open, softHu) - slack || y > std::max(open, softHu) + slack)
            return std::nullopt;
        const double soft = sum / weight;
        // At least what must be tagged if all the rest is wall, at most what may be if it is air.
        const double least = std::max(0.0, (y - softHu) / (taggedHu - softHu));
        const double most = std::max(0.0, (y - airHu) / (taggedHu - airHu));
        const double tagged =
            std::clamp((1.0 - soft) * fluidAt(*depth), std::min(least, most), most);
        // Equation 3.1 gives the rest.
        const double wall = (y - tagged * taggedHu - (1.0 - tagged) * airHu) / (softHu - airHu);
        // What is brighter than the tagged material is no wall.
        const double rest = 1.0 - tagged;
        return roundedFractions(rest - std::min(std::max(wall, 0.0), rest), tagged);
    }

    /// Whether fluid, whose top this voxel can hold, lies below it or beside the voxel below.
    bool aboveFluid(glm::ivec3 v, double softHu, double taggedHu) const {
        const glm::ivec3 down = level_.down();
        if (down == glm::ivec3(0)) return false;
        const double least =
            softHu + std::max(0.15 * (taggedHu - softHu), 2.0 * means_.noise.tagged);
        for (int b = -1; b <= 1; ++b) {
            for (int a = -1; a <= 1; ++a) {
                const glm::ivec3 aside = down.x   ? glm::ivec3(0, a, b)
                                         : down.y ? glm::ivec3(a, 0, b)
                                                  : glm::ivec3(a, b, 0);
                const glm::ivec3 n = v + (down + aside) * look_;
                if (hu_.grid().contains(n) && hu_.at(n) > least) return true;
            }
        }
        return false;
    }

    /// Whether soft tissue lies within 2 mm, in a row that the level has not given its HU.
    bool besideWall(glm::ivec3 v, double softHu, double taggedHu) const {
        const Grid& grid = hu_.grid();
        const glm::ivec3 down = level_.down();
        if (down == glm::ivec3(0)) return false;
        const glm::ivec3 reach =
            glm::max(glm::ivec3(glm::floor(2.0 / grid.spacingMm())), glm::ivec3(1));
        const double tolerance = std::max(3.0 * means_.noise.soft, 0.15 * (taggedHu - softHu));
        const auto isSoft = [&](glm::ivec3 n) {
            return grid.contains(n) && std::abs(hu_.at(n) - softHu) < tolerance;
        };
        bool found = false;
        eachStep(grid, v, reach, look_, [&](glm::ivec3 n) {
            // Wall goes on above or below; a level does not.
            found = found || (isSoft(n) && (isSoft(n + down * look_) || isSoft(n - down * look_)));
        });
        return found;
    }

    Neighbours look(glm::ivec3 v, double softHu, double taggedHu) const {
        const Grid& grid = hu_.grid();
        Neighbours around;
        for (int c = -1; c <= 1; ++c) {
            for (int b = -1; b <= 1; ++b) {
                for (int a = -1; a <= 1; ++a) {
                    const std::size_t n = grid.index(
                        glm::clamp(v + glm::ivec3(a, b, c) * look_, glm::ivec3(0), grid.size - 1));
                    const double share = (hu_[n] - softHu) / (taggedHu - softHu);
                    around.meanShare += share / 27.0;
                    around.leastShare = std::min(around.leastShare, share);
                    around.tagged |=
                        share > 0.4 && LumenLabel(segmentation_[n]) == LumenLabel::tagged;
                }
            }
        }
        around.tagged |= LumenLabel(segmentation_.at(v)) == LumenLabel::tagged;
        return around;
    }

    const Volume<std::int16_t>& hu_;
    const Volume<std::uint8_t>& segmentation_;
    const LocalMeans& means_;
    const InterfaceLayer& interfaces_;
    const WaterLevel& level_;
    glm::ivec3 look_;
    double levelMm_;      ///< between rows
    double levelBlurMm_;  ///< of a level, standard deviation
};

}  // namespace

Result<Volume<TissueFractions>> estimateMixture(const CtScan& scan, const TissueModel& tissue,
                                                const Volume<std::uint8_t>& segmentation,
                                                glm::dvec3 gravity, const MixtureOptions& options) {
    auto part = TRY(cropToLumen(scan, segmentation, options.threads));
    const PartialVolumeModel model = fitPartialVolume(scan, tissue, options.threads);
    if (!part)
        return estimateMixture(scan, model, {}, nullptr, gravity, options).whole(options.threads);
    auto byHu = fractionsByHu(part->scan.hu, model, options.threads);
    const TaggedLumen lumen = measureTaggedLumen(std::move(*part), tissue, options.threads);
    return estimateMixture(scan, model, std::move(byHu), &lumen, gravity, options)
        .whole(options.threads);
}

Volume<TissueFractions> fractionsByHu(const Volume<std::int16_t>& hu,
                                      const PartialVolumeModel& model, int threads) {
    Volume<TissueFractions> fractions(hu.grid());
    const auto out = fractions.writable();
    parallelFor(out.size(), std::size_t(1) << 20, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            out[n] = model.fractionsOf(hu[n]);
    });
    return fractions;
}

BoxedVolume<TissueFractions> estimateMixture(const CtScan& scan, const PartialVolumeModel& model,
                                             Volume<TissueFractions> byHu, const TaggedLumen* lumen,
                                             glm::dvec3 gravity, const MixtureOptions& options) {
    auto progress = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    progress(0.0);
    BoxedVolume<TissueFractions> result;
    result.grid = scan.hu.grid();
    // std::function wants what it holds to be copyable; a Volume is not, a pointer to one is.
    result.beyond = [model, hu = std::make_shared<const Volume<std::int16_t>>(scan.hu.share())](
                        glm::ivec3 first, std::span<TissueFractions> row) {
        const std::int16_t* from = &hu->voxels()[hu->grid().index(first)];
        for (std::size_t i = 0; i < row.size(); ++i)
            row[i] = model.fractionsOf(from[i]);
    };
    if (!lumen) return result;
    const int threads = options.threads;
    const CtScan& seen = lumen->scan;
    const Volume<std::uint8_t>& labels = lumen->labels;
    const LocalMeans& means = lumen->means;
    const TaggedSurroundings& around = lumen->around;
    Volume<TissueFractions> mixture = std::move(byHu);
    const auto out = mixture.writable();
    progress(0.2);
    const PointSpread spread = measurePointSpread(seen, labels, means, threads);
    const InterfaceLayer interfaces(seen, labels, means, spread, gravity);
    progress(0.4);
    const WaterLevel level(seen, means, interfaces, around, gravity, threads);
    const ColonMixture colon(seen, labels, means, interfaces, level);
    // The model of two tissues knows no fat and takes it for part air. Where it finds no tagging, a
    // voxel therefore holds no more air than its HU alone would say, as far from the colon.
    std::vector<std::vector<std::uint8_t>> mostAir(around.shells.size());
    for (std::size_t s = 0; s < around.shells.size(); ++s) {
        const auto& shell = around.shells[s];
        mostAir[s].resize(shell.size());
        parallelFor(shell.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) {
                mostAir[s][n] = out[shell[n]].air;
                out[shell[n]] = colon.at(shell[n]);
            }
        });
    }
    progress(0.6);
    settleSubmerged(seen, labels, means, spread, around, mixture, threads);
    progress(0.8);
    const Volume<std::uint8_t> films =
        settleFilms(seen, labels, means, spread, around, mixture, threads);
    settleRim(seen, labels, means, level, spread, around, films, mixture, threads);
    for (std::size_t s = 0; s < around.shells.size(); ++s) {
        for (std::size_t n = 0; n < mostAir[s].size(); ++n) {
            TissueFractions& fractions = out[around.shells[s][n]];
            if (fractions.tagged == 0) fractions.air = std::min(fractions.air, mostAir[s][n]);
        }
    }
    result.box = lumen->box, result.part = std::move(mixture);
    progress(1.0);
    return result;
}

}  // namespace haustra::cleansing
