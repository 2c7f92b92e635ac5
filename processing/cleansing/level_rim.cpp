#include "cleansing/level_rim.h"

#include "cleansing/ball.h"
#include "core/parallel.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace haustra::cleansing {
namespace {

constexpr double windowMm = 5.0;  // in which the wall's direction is sought
constexpr double mostBent = 0.1;  // share of the squared gradients along that direction
constexpr double steepest = 1.5;  // mm across per mm of height; a flatter wall gives no direction

class Rim {
public:
    Rim(const Volume<std::int16_t>& cleansed, const LocalMeans& means, const WaterLevel& level,
        double halfHeightMm)
        : hu_(cleansed),
          means_(means),
          level_(level),
          halfHeightMm_(halfHeightMm),
          spacingMm_(cleansed.grid().spacingMm()),
          look_(neighbourStep(cleansed.grid())) {
        for (int axis = 0; axis < 3; ++axis) {
            if (level.down()[axis] != 0) vertical_ = axis;
        }
        across_ = {vertical_ == 0 ? 1 : 0, vertical_ == 2 ? 1 : 2};
        const glm::ivec3 near = voxelsIn(cleansed.grid(), 1.5) / look_;
        for (int k = -near.z; k <= near.z; ++k) {
            for (int j = -near.y; j <= near.y; ++j) {
                for (int i = -near.x; i <= near.x; ++i)
                    beside_.push_back(glm::ivec3(i, j, k) * look_);
            }
        }
        const glm::ivec3 reach = glm::ivec3(windowMm / spacingMm_) / look_;
        windowReach_ = reach * look_;
        for (int k = -reach.z; k <= reach.z; ++k) {
            for (int j = -reach.y; j <= reach.y; ++j) {
                for (int i = -reach.x; i <= reach.x; ++i) {
                    const glm::ivec3 voxels = glm::ivec3(i, j, k) * look_;
                    const glm::dvec3 d = glm::dvec3(voxels) * spacingMm_;
                    const double distance2 = glm::dot(d, d);
                    if (distance2 > windowMm * windowMm) continue;
                    window_.push_back({voxels, stepOf(voxels),
                                       d[vertical_] * level.down()[vertical_],
                                       std::exp(-0.5 * distance2 / 4.0)});
                }
            }
        }
    }

    /// HU that the wall above and below gives a voxel.
    std::optional<double> huAt(glm::ivec3 v) const {
        if (!besideWall(v)) return std::nullopt;
        const auto depth = level_.depthMm(v);
        if (!depth || std::abs(*depth) > halfHeightMm_) return std::nullopt;
        const auto slope = direction(v, *depth);
        if (!slope) return std::nullopt;
        const double beyond = halfHeightMm_ + 0.5 * spacingMm_[vertical_];
        const double above = sample(v, *slope, -beyond - *depth),
                     below = sample(v, *slope, beyond - *depth);
        return glm::mix(above, below, (*depth + beyond) / (2.0 * beyond));
    }

private:
    double sample(glm::ivec3 v, glm::dvec2 slope, double downMm) const {
        glm::dvec3 p(v);
        p[vertical_] += downMm * level_.down()[vertical_] / spacingMm_[vertical_];
        p[across_[0]] += downMm * slope.x / spacingMm_[across_[0]];
        p[across_[1]] += downMm * slope.y / spacingMm_[across_[1]];
        return trilinear(hu_, glm::clamp(p, glm::dvec3(0.0), glm::dvec3(hu_.grid().size - 1)));
    }

    bool besideWall(glm::ivec3 v) const {
        const double air = means_.airHu.at(v.x, v.y, v.z), soft = means_.softHu.at(v.x, v.y, v.z);
        const double least = air + 0.3 * (soft - air);
        return std::any_of(beside_.begin(), beside_.end(), [&](glm::ivec3 step) {
            return hu_.grid().contains(v + step) && hu_.at(v + step) > least;
        });
    }

    /// How far the wall leans, mm across per mm of depth: least squares over the gradients above
    /// and below the level's blur.
    std::optional<glm::dvec2> direction(glm::ivec3 v, double depthMm) const {
        const Grid& grid = hu_.grid();
        const double clear = halfHeightMm_ + spacingMm_[vertical_];
        const glm::ivec3 reach = windowReach_ + look_;
        const bool inside = glm::all(glm::greaterThanEqual(v, reach)) &&
                            glm::all(glm::lessThan(v, grid.size - reach));
        const std::int16_t* const here = &hu_.voxels()[grid.index(v)];
        // Across, and along the vertical: to the neighbours, and mm between them.
        const std::array<int, 3> axes{across_[0], across_[1], vertical_};
        std::array<std::ptrdiff_t, 3> step{};
        std::array<double, 3> apartMm{};
        for (std::size_t n = 0; n < 3; ++n) {
            glm::ivec3 look(0);
            look[axes[n]] = look_[axes[n]];
            step[n] = stepOf(look), apartMm[n] = 2.0 * look_[axes[n]] * spacingMm_[axes[n]];
        }
        double aa = 0.0, ab = 0.0, bb = 0.0, av = 0.0, bv = 0.0, vv = 0.0;
        for (const Place& place : window_) {
            if (std::abs(depthMm + place.downMm) < clear) continue;
            const glm::ivec3 n = v + place.voxels;
            if (!inside && (!grid.contains(n - look_) || !grid.contains(n + look_))) continue;
            const std::int16_t* const there = here + place.step;
            const auto along = [&](std::size_t axis) {
                return (there[step[axis]] - there[-step[axis]]) / apartMm[axis];
            };
            const double a = along(0), b = along(1), down = along(2) * level_.down()[vertical_];
            const double w = place.weight;
            aa += w * a * a, ab += w * a * b, bb += w * b * b;
            av += w * a * down, bv += w * b * down, vv += w * down * down;
        }
        // Upright unless the gradients say otherwise.
        const double ridge = 0.01 * (aa + bb + vv) + 1e-3;
        aa += ridge, bb += ridge;
        const double determinant = aa * bb - ab * ab;
        const glm::dvec2 slope((-av * bb + bv * ab) / determinant,
                               (-bv * aa + av * ab) / determinant);
        if (glm::length(slope) > steepest) return std::nullopt;
        // What the gradients still hold along that direction: a bent wall, or several.
        const double along = aa * slope.x * slope.x + 2.0 * ab * slope.x * slope.y +
                             bb * slope.y * slope.y + 2.0 * (av * slope.x + bv * slope.y) + vv;
        if (along > mostBent * (1.0 + glm::dot(slope, slope)) * (aa + bb + vv)) return std::nullopt;
        return slope;
    }

    /// Of the window in which the wall's direction is sought.
    struct Place {
        glm::ivec3 voxels;
        std::ptrdiff_t step;  ///< the same, between indices
        double downMm, weight;
    };
    std::ptrdiff_t stepOf(glm::ivec3 voxels) const {
        const glm::ivec3 size = hu_.grid().size;
        return voxels.x + std::ptrdiff_t(size.x) * (voxels.y + std::ptrdiff_t(size.y) * voxels.z);
    }

    const Volume<std::int16_t>& hu_;
    const LocalMeans& means_;
    const WaterLevel& level_;
    std::vector<glm::ivec3> beside_;
    std::vector<Place> window_;
    double halfHeightMm_;
    glm::dvec3 spacingMm_;
    glm::ivec3 look_, windowReach_{0};
    int vertical_ = 1;
    glm::ivec2 across_{0, 2};
};

/// Whether the segmentation has both air and tagging within 1.5 mm.
bool betweenAirAndFluid(const Volume<std::uint8_t>& segmentation, glm::ivec3 v) {
    const glm::ivec3 reach = voxelsIn(segmentation.grid(), 1.5);
    const glm::ivec3 lo = glm::max(v - reach, glm::ivec3(0)),
                     hi = glm::min(v + reach, segmentation.grid().size - 1);
    bool air = false, tagged = false;
    return anyInBox(lo, hi, [&](glm::ivec3 w) {
        const LumenLabel label{segmentation.at(w)};
        air |= label == LumenLabel::air, tagged |= label == LumenLabel::tagged;
        return air && tagged;
    });
}

/// The third lowest HU of the neighbours along the axes: a sheet as thin has but two that are open,
/// a ridge or speck has three and more.
double thirdLowestAround(const Volume<std::int16_t>& hu, glm::ivec3 v) {
    const glm::ivec3 look = neighbourStep(hu.grid());
    std::array<std::int16_t, 6> values;
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = -1; side <= 1; side += 2) {
            glm::ivec3 n = v;
            n[axis] += side * look[axis];
            values[count++] = hu.at(glm::clamp(n, glm::ivec3(0), hu.grid().size - 1));
        }
    }
    std::sort(values.begin(), values.end());
    return values[2];
}

}  // namespace

void settleRim(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
               const LocalMeans& means, const WaterLevel& level, const PointSpread& spread,
               const TaggedSurroundings& around, const Volume<std::uint8_t>& settled,
               Volume<TissueFractions>& mixture, int threads) {
    if (level.down() == glm::ivec3(0)) return;
    const Grid& grid = scan.hu.grid();
    const auto airAt = [&](glm::ivec3 v) { return means.airHu.at(v.x, v.y, v.z); };
    Volume<std::int16_t> cleansed = scan.hu.clone();
    const auto first = cleansed.writable();
    const auto out = mixture.writable();
    for (const auto& shell : around.shells) {
        parallelFor(shell.size(), 1 << 13, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                const std::size_t n = shell[m];
                const glm::ivec3 v = grid.voxelAt(n);
                const double contrast = means.taggedHu.at(v) - airAt(v);
                first[n] = std::int16_t(std::clamp(
                    std::lround(scan.hu[n] - out[n].tagged / 255.0 * contrast), -1024L, 3071L));
            }
        });
    }
    const Rim rim(cleansed, means, level, 2.5 * spread.acrossMm(glm::dvec3(level.down())));
    for (const auto& shell : around.shells) {
        parallelFor(shell.size(), 1 << 12, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                const std::size_t n = shell[m];
                const glm::ivec3 v = grid.voxelAt(n);
                if (settled[n] || !level.near(v)) continue;
                auto straight = rim.huAt(v);
                if (!straight) {
                    const double open = thirdLowestAround(cleansed, v);
                    if (cleansed[n] > open + 6.0 * means.noise.tagged &&
                        betweenAirAndFluid(segmentation, v))
                        straight = open;
                }
                if (!straight) continue;
                const double air = airAt(v), soft = means.softHu.at(v.x, v.y, v.z);
                const double taggedHu = std::max<double>(means.taggedHu.at(v), soft + 60.0);
                // A voxel as dense as fluid has no room for wall.
                const double room = (taggedHu - scan.hu[n]) / (taggedHu - soft);
                const double hu = std::min(
                    *straight, air + (soft - air) * std::max(0.0, room) + 2.0 * means.noise.tagged);
                const double tagged = std::clamp((scan.hu[n] - hu) / (taggedHu - air), 0.0, 1.0);
                const double open = std::clamp((soft - hu) / (soft - air), 0.0, 1.0);
                const int t = int(std::lround(255.0 * tagged));
                out[n] = {std::uint8_t(std::clamp(int(std::lround(255.0 * open)) - t, 0, 255 - t)),
                          std::uint8_t(t)};
            }
        });
    }
}

}  // namespace haustra::cleansing
