#include "cleansing/rim_smoothing.h"

#include "cleansing/ball.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace haustra::cleansing {
namespace {

constexpr double airReachMm = 2.1;      // the line's band: air and tagging are this near
constexpr double flowMm2 = 0.5;         // time that the curvature acts
constexpr double faintHuPerMm = 300.0;  // a slope that is no wall's face
constexpr double roughHu = 150.0;       // what moves a voxel by more is no wall's shape
constexpr double aroundRoughMm = 1.5;
constexpr double stableStep = 0.1;      // of the squared smallest spacing
constexpr double besideWallHu = 150.0;  // how far from the wall's HU its blur is still seen

using Neighbourhood = std::array<std::uint32_t, 27>;

/// The wall passes a voxel or its neighbours.
bool besideWall(const Volume<std::int16_t>& hu, glm::ivec3 v, glm::ivec3 look, double wallHu) {
    const glm::ivec3 last = hu.grid().size - 1;
    int least = 32767, most = -32768;
    for (int c = -1; c <= 1; ++c) {
        for (int b = -1; b <= 1; ++b) {
            for (int a = -1; a <= 1; ++a) {
                const int there =
                    hu.at(glm::clamp(v + glm::ivec3(a, b, c) * look, glm::ivec3(0), last));
                least = std::min(least, there), most = std::max(most, there);
            }
        }
    }
    return least < wallHu + besideWallHu && most > wallHu - besideWallHu;
}

bool isInterior(const Grid& grid, glm::ivec3 v) {
    return glm::all(glm::greaterThan(v, glm::ivec3(0))) &&
           glm::all(glm::lessThan(v, grid.size - 1));
}

/// Of a symmetric matrix, the eigenvalue of the largest magnitude (Smith 1961).
double strongestEigenvalue(double xx, double yy, double zz, double xy, double xz, double yz) {
    const double mean = (xx + yy + zz) / 3.0;
    const double a = xx - mean, b = yy - mean, c = zz - mean;
    const double p = std::sqrt((a * a + b * b + c * c + 2.0 * (xy * xy + xz * xz + yz * yz)) / 6.0);
    if (p < 1e-9) return mean;
    const double determinant =
        a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
    const double angle = std::acos(std::clamp(determinant / (2.0 * p * p * p), -1.0, 1.0)) / 3.0;
    const double most = mean + 2.0 * p * std::cos(angle),
                 least = mean + 2.0 * p * std::cos(angle + 2.0 * std::numbers::pi / 3.0);
    return std::abs(most) > std::abs(least) ? most : least;
}

/// Δf less its part along the gradient: |∇f| times the mean curvature of the level surface.
/// Differences are per mm; `inverse` is 1 / spacing.
double curvatureSpeed(const std::vector<float>& f, const Neighbourhood& at, glm::dvec3 inverse) {
    const auto g = [&](int a, int b, int c) {
        return double(f[at[std::size_t(13 + a + 3 * b + 9 * c)]]);
    };
    const double here = g(0, 0, 0);
    const double x = 0.5 * inverse.x * (g(1, 0, 0) - g(-1, 0, 0)),
                 y = 0.5 * inverse.y * (g(0, 1, 0) - g(0, -1, 0)),
                 z = 0.5 * inverse.z * (g(0, 0, 1) - g(0, 0, -1));
    const double xx = inverse.x * inverse.x * (g(1, 0, 0) + g(-1, 0, 0) - 2.0 * here),
                 yy = inverse.y * inverse.y * (g(0, 1, 0) + g(0, -1, 0) - 2.0 * here),
                 zz = inverse.z * inverse.z * (g(0, 0, 1) + g(0, 0, -1) - 2.0 * here);
    const double xy = 0.25 * inverse.x * inverse.y *
                      (g(1, 1, 0) + g(-1, -1, 0) - g(1, -1, 0) - g(-1, 1, 0)),
                 xz = 0.25 * inverse.x * inverse.z *
                      (g(1, 0, 1) + g(-1, 0, -1) - g(1, 0, -1) - g(-1, 0, 1)),
                 yz = 0.25 * inverse.y * inverse.z *
                      (g(0, 1, 1) + g(0, -1, -1) - g(0, 1, -1) - g(0, -1, 1));
    const double along =
        x * x * xx + y * y * yy + z * z * zz + 2.0 * (x * y * xy + x * z * xz + y * z * yz);
    // On a thin sheet's crest the gradient says nothing: the strongest bending is across it.
    const double faint = faintHuPerMm * faintHuPerMm;
    return xx + yy + zz -
           (along + faint * strongestEigenvalue(xx, yy, zz, xy, xz, yz)) /
               (x * x + y * y + z * z + faint);
}

/// Voxels near both air and tagging that the wall passes, ascending.
std::vector<std::uint32_t> bandOf(const Volume<std::int16_t>& hu,
                                  const Volume<std::uint8_t>& labels, double wallHu,
                                  const TaggedSurroundings& around, int threads) {
    const Grid& grid = hu.grid();
    const glm::ivec3 look = neighbourStep(grid);
    const Ball reach(grid, glm::dvec3(airReachMm));
    const auto isAir = [&](std::size_t n) { return LumenLabel(labels[n]) == LumenLabel::air; };
    std::vector<std::uint32_t> band;
    for (const auto& shell : around.shells) {
        std::vector<char> in(shell.size());
        parallelFor(shell.size(), 1 << 13, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                const glm::ivec3 v = grid.voxelAt(shell[m]);
                in[m] = isInterior(grid, v) && besideWall(hu, v, look, wallHu) &&
                        (isAir(shell[m]) ||
                         !reach.everywhere(v, [&](std::size_t n) { return !isAir(n); }));
            }
        });
        for (std::size_t m = 0; m < shell.size(); ++m) {
            if (in[m]) band.push_back(shell[m]);
        }
    }
    std::sort(band.begin(), band.end());
    return band;
}

/// The band and all that touches it, by itself: it is a small part of the scan.
class Band {
public:
    Band(const Volume<std::int16_t>& hu, const std::vector<std::uint32_t>& band, int threads)
        : spacingMm_(hu.grid().spacingMm()), near_(band.size()), threads_(threads) {
        const Grid& grid = hu.grid();
        std::vector<std::uint32_t> voxels;
        voxels.reserve(27 * band.size());
        for (const std::uint32_t n : band) {
            for (int k = 0; k < 27; ++k)
                voxels.push_back(std::uint32_t(grid.index(grid.voxelAt(n) + cornerStep(k))));
        }
        std::sort(voxels.begin(), voxels.end());
        voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
        for (const std::uint32_t n : voxels)
            values_.push_back(hu[n]);
        before_ = values_;
        parallelFor(band.size(), 1 << 13, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                for (int k = 0; k < 27; ++k) {
                    const auto n = std::uint32_t(grid.index(grid.voxelAt(band[m]) + cornerStep(k)));
                    near_[m][std::size_t(k)] = std::uint32_t(
                        std::lower_bound(voxels.begin(), voxels.end(), n) - voxels.begin());
                }
            }
        });
    }

    /// Moves the wall by its curvature.
    void flow() {
        const double least = leastSpacingMm();
        const int steps = std::max(1, int(std::ceil(flowMm2 / (stableStep * least * least))));
        const double step = flowMm2 / steps;
        std::vector<float> next = values_;
        for (int s = 0; s < steps; ++s) {
            parallelFor(near_.size(), 1 << 13, threads_, [&](std::size_t begin, std::size_t end) {
                for (std::size_t m = begin; m < end; ++m) {
                    const std::uint32_t here = near_[m][13];
                    next[here] = float(values_[here] +
                                       step * curvatureSpeed(values_, near_[m], 1.0 / spacingMm_));
                }
            });
            std::swap(values_, next);
        }
    }

    /// Of each of the band's voxels: whether something rough has gone there, or 1.5 mm around it.
    std::vector<char> roughPlaces() const {
        std::vector<char> moves(values_.size(), 0);
        for (const Neighbourhood& near : near_)
            moves[near[13]] = std::abs(values_[near[13]] - before_[near[13]]) > roughHu;
        const int rings = std::max(1, int(std::lround(aroundRoughMm / leastSpacingMm())));
        for (int ring = 0; ring < rings; ++ring) {
            const std::vector<char> inner = moves;
            for (const Neighbourhood& near : near_) {
                if (!inner[near[13]]) continue;
                for (const std::uint32_t n : near)
                    moves[n] = 1;
            }
        }
        std::vector<char> rough;
        for (const Neighbourhood& near : near_)
            rough.push_back(moves[near[13]]);
        return rough;
    }

    float value(std::size_t m) const { return values_[near_[m][13]]; }

private:
    double leastSpacingMm() const { return std::min({spacingMm_.x, spacingMm_.y, spacingMm_.z}); }

    const glm::dvec3 spacingMm_;
    std::vector<Neighbourhood> near_;  ///< of each of the band's voxels, itself and those around it
    std::vector<float> values_, before_;  ///< HU of each of those, now and before the flow
    const int threads_;
};

}  // namespace

std::vector<std::uint32_t> smoothRim(Volume<std::int16_t>& hu, const Volume<std::uint8_t>& labels,
                                     const TissueModel& tissue, const TaggedSurroundings& around,
                                     int threads) {
    const std::vector<std::uint32_t> voxels =
        bandOf(hu, labels, tissue.airBelowHu, around, threads);
    Band band(hu, voxels, threads);
    band.flow();
    // Only at rough places: the rest stays as it was.
    const std::vector<char> rough = band.roughPlaces();
    const auto out = hu.writable();
    std::vector<std::uint32_t> moved;
    for (std::size_t m = 0; m < voxels.size(); ++m) {
        if (!rough[m]) continue;
        out[voxels[m]] = std::int16_t(std::clamp(std::lround(band.value(m)), -1024L, 3071L));
        moved.push_back(voxels[m]);
    }
    return moved;
}

}  // namespace haustra::cleansing
