#include "cleansing/submerged_mixture.h"

#include "cleansing/ball.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace haustra::cleansing {
namespace {

constexpr double coupling = 10.0;  // β; of 10 and 60, on phantoms 1 and 2
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

/// HU at a voxel by its neighbours: of the quadratic fitted to the 27, and by
/// binomial weights.
struct Filtered {
    double quadratic = 0.0, binomial = 0.0;
};
Filtered filteredAt(const Volume<std::int16_t>& hu, glm::ivec3 v, glm::ivec3 look) {
    const glm::ivec3 last = hu.grid().size - 1;
    Filtered sum;
    for (int c = -1; c <= 1; ++c) {
        for (int b = -1; b <= 1; ++b) {
            for (int a = -1; a <= 1; ++a) {
                const int away = a * a + b * b + c * c;
                const double y =
                    hu.at(glm::clamp(v + glm::ivec3(a, b, c) * look, glm::ivec3(0), last));
                sum.quadratic += y * (7 - 3 * away) / 27.0;
                sum.binomial += y * double(8 >> away) / 64.0;
            }
        }
    }
    return sum;
}

/// Of a symmetric matrix (Smith 1961).
double largestEigenvalue(const glm::dmat3& m) {
    const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
    const glm::dmat3 rest = m - glm::dmat3(mean);
    double squares = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        squares += glm::dot(rest[axis], rest[axis]);
    const double p = std::sqrt(squares / 6.0);
    if (p < 1e-9) return mean;
    const double cosine = std::clamp(glm::determinant(rest) / (2.0 * p * p * p), -1.0, 1.0);
    return mean + 2.0 * p * std::cos(std::acos(cosine) / 3.0);
}

}  // namespace

double structureSignature(const Volume<std::int16_t>& hu, glm::ivec3 voxel, double noiseSd) {
    const Grid& grid = hu.grid();
    const glm::ivec3 look = neighbourStep(grid);
    if (!grid.contains(voxel - look) || !grid.contains(voxel + look)) return 0.0;
    // In standard deviations of a second difference, so that each axis counts by its own noise.
    glm::dmat3 hessian;
    for (int a = 0; a < 3; ++a) {
        glm::ivec3 u(0);
        u[a] = look[a];
        hessian[a][a] = hu.at(voxel + u) - 2.0 * hu.at(voxel) + hu.at(voxel - u);
        for (int b = 0; b < a; ++b) {
            glm::ivec3 w(0);
            w[b] = look[b];
            hessian[a][b] = hessian[b][a] = 0.25 * (hu.at(voxel + u + w) - hu.at(voxel + u - w) -
                                                    hu.at(voxel - u + w) + hu.at(voxel - u - w));
        }
    }
    const double bend = largestEigenvalue(hessian) / (std::sqrt(6.0) * noiseSd);
    return std::clamp((bend - 2.5) / 1.5, 0.0, 1.0);
}

void settleSubmerged(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                     const LocalMeans& means, const PointSpread& spread,
                     const TaggedSurroundings& around, Volume<TissueFractions>& mixture,
                     int threads) {
    const Grid& grid = scan.hu.grid();
    const Ball reach(grid, gasReach * spread.sdMm);
    const glm::dvec3 apart = grid.spacingMm() / spread.sdMm;
    const glm::dvec3 near = glm::exp(-0.5 * apart * apart);
    const double sd = std::max(means.noise.soft, means.noise.tagged);
    const glm::ivec3 look = neighbourStep(grid);
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
                    !reach.everywhere(v, isNoGas))
                    continue;
                const Filtered filtered = filteredAt(scan.hu, v, look);
                if (mixture[n].tagged == 0 &&
                    filtered.binomial - soft < std::max(unlabelledShare * contrast, 2.0 * sd))
                    continue;
                // Taking tagging out amplifies the noise by the contrast of air: where that is
                // worse than the blur of a filter, the neighbours say what the scan shows.
                const double noise = sd / contrast, bend = structureSignature(scan.hu, v, sd);
                const double weak = (1.0 - bend) * std::clamp((noise - 0.06) / 0.08, 0.0, 1.0);
                const double weaker = std::clamp((noise - 0.14) / 0.1, 0.0, 1.0);
                const double y =
                    glm::mix(double(scan.hu[n]),
                             glm::mix(filtered.quadratic, filtered.binomial, weaker), weak);
                found[m].share = float(std::clamp((y - soft) / contrast, 0.0, 1.0));
                found[m].certainty = float(contrast * contrast / (sd * sd));
                found[m].coupling = float(coupling * (1.0 - bend));
            }
        });
        for (const Place& place : found) {
            if (place.certainty > 0.0f) places.push_back(place);
        }
    }
    std::vector<float> next(places.size());
    for (const Place& place : places)
        out[place.voxel] = roundedFractions(0.0, place.share);
    const auto meanWithNeighbours = [&](const Place& place) {
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
        return float(sum / weight);
    };
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        parallelFor(places.size(), 1 << 13, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m)
                next[m] = meanWithNeighbours(places[m]);
        });
        for (std::size_t m = 0; m < places.size(); ++m)
            out[places[m].voxel] = roundedFractions(0.0, next[m]);
    }
}

}  // namespace haustra::cleansing
