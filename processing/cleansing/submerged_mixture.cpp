#include "cleansing/submerged_mixture.h"

#include "cleansing/ball.h"
#include "cleansing/structure_signature.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::cleansing {
namespace {

constexpr double coupling = 10.0;  // β; on seeds 1 and 2 of the phantoms 10 and 60 were tried
constexpr int sweeps = 6;
constexpr double gasReach = 2.6;  // standard deviations of the blur

/// Of voxels that no label holds, the least share around them for which they are not noise.
constexpr double unlabelledShare = 0.4;

struct Place {
    std::uint32_t voxel;
    float share;      ///< that the scan alone gives
    float certainty;  ///< squared contrast over noise
    float coupling;
};

/// Mean of a voxel and those a look to either side along the axes.
double crossMean(const Volume<std::int16_t>& hu, glm::ivec3 v) {
    const glm::ivec3 look = lookStep(hu.grid()), last = hu.grid().size - 1;
    double sum = hu.at(v);
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = -1; side <= 1; side += 2) {
            glm::ivec3 n = v;
            n[axis] += side * look[axis];
            sum += hu.at(glm::clamp(n, glm::ivec3(0), last));
        }
    }
    return sum / 7.0;
}

}  // namespace

void settleSubmerged(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                     const LocalMeans& means, const PointSpread& spread,
                     const TaggedSurroundings& around, Volume<TissueFractions>& mixture,
                     int threads) {
    const Grid& grid = scan.hu.grid();
    const auto reach = ballOffsets(grid, gasReach * spread.sdMm);
    const glm::dvec3 apart = grid.spacingMm() / spread.sdMm;
    const glm::dvec3 near = glm::exp(-0.5 * apart * apart);
    const double sd = std::max(means.noise.soft, means.noise.tagged);
    const auto isNoGas = [&](std::size_t n) {
        return LumenLabel(segmentation[n]) != LumenLabel::air;
    };
    const auto out = mixture.writable();
    std::vector<Place> places;
    for (const auto& shell : around.shells) {
        std::vector<Place> found(shell.size());
        parallelFor(shell.size(), 1 << 12, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                const std::uint32_t n = shell[m];
                const glm::ivec3 v = grid.voxelAt(n);
                const double soft = means.softHu.at(v.x, v.y, v.z),
                             contrast = std::max(60.0, means.taggedHu.at(v) - soft);
                found[m].voxel = n;
                if (mixture[n].tagged == 255 || mixture[n].air > 0 || !isNoGas(n) ||
                    !everywhere(grid, reach, v, isNoGas))
                    continue;
                if (mixture[n].tagged == 0 &&
                    crossMean(scan.hu, v) - soft < std::max(unlabelledShare * contrast, 2.0 * sd))
                    continue;
                found[m].share = float(std::clamp((scan.hu[n] - soft) / contrast, 0.0, 1.0));
                found[m].certainty = float(contrast * contrast / (sd * sd));
                found[m].coupling = float(coupling * (1.0 - structureSignature(scan.hu, v, sd)));
            }
        });
        for (const Place& place : found) {
            if (place.certainty > 0.0f) places.push_back(place);
        }
    }
    std::vector<float> next(places.size());
    for (const Place& place : places)
        out[place.voxel] = roundedFractions(0.0, place.share);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        parallelFor(places.size(), 1 << 13, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                const Place& place = places[m];
                const glm::ivec3 v = grid.voxelAt(place.voxel);
                double weight = place.certainty, sum = weight * place.share;
                for (int axis = 0; axis < 3; ++axis) {
                    for (int side = -1; side <= 1; side += 2) {
                        glm::ivec3 n = v;
                        n[axis] += side;
                        if (!grid.contains(n)) continue;
                        const double w = place.coupling * near[axis];
                        weight += w, sum += w * mixture.at(n).tagged / 255.0;
                    }
                }
                next[m] = float(sum / weight);
            }
        });
        for (std::size_t m = 0; m < places.size(); ++m)
            out[places[m].voxel] = roundedFractions(0.0, next[m]);
    }
}

}  // namespace haustra::cleansing
