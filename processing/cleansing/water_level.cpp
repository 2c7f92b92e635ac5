#include "cleansing/water_level.h"

#include "cleansing/ball.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace haustra::cleansing {
namespace {

/// A smaller level is the top of a ball of stool, which needs no wall to hold it.
constexpr double smallestMm2 = 9.5;
constexpr double acrossMm = 6.0, heightMm = 3.0;  // as far as a level is known from a column

}  // namespace

WaterLevel::WaterLevel(const CtScan& scan, const LocalMeans& means,
                       const InterfaceLayer& interfaces, const TaggedSurroundings& around,
                       glm::dvec3 gravity, int threads) {
    grid_ = scan.hu.grid();
    const Grid& grid = grid_;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 direction = glm::normalize(glm::dvec3(grid.patientFromVoxel[axis]));
        const double along = glm::dot(direction, gravity);
        if (std::abs(along) < 0.95) continue;
        down_[axis] = along > 0.0 ? 1 : -1;
        stepMm_ = grid.spacingMm()[axis];
        vertical_ = axis;
    }
    if (down_ == glm::ivec3(0)) return;
    across_ = {vertical_ == 0 ? 1 : 0, vertical_ == 2 ? 1 : 2};
    const glm::ivec3 look = lookStep(grid);
    const glm::dvec3 spacing = grid.spacingMm();
    const glm::ivec3 flat = glm::ivec3(1) - glm::abs(down_);
    acrossStep_ = glm::max(look * flat, glm::ivec3(1));
    fewestColumns_ = smallestMm2 * stepMm_ / grid.voxelVolumeMm3() /
                     (acrossStep_.x * acrossStep_.y * acrossStep_.z);
    blockVoxels_ = voxelsIn(grid, heightMm);
    struct Found {
        std::size_t column;
        Crossing crossing;
    };
    std::vector<Found> found;
    // A steeper surface is no level, or a wall's blur has tilted it.
    constexpr double steepest = 0.12, surelyBare = 0.9;
    for (const auto& shell : around.shells) {
        // 0, or 1 + 254 f where the level crosses f of the way to the voxel below.
        std::vector<std::uint8_t> out(shell.size(), 0);
        parallelFor(shell.size(), 1 << 13, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                const glm::ivec3 v = grid.voxelAt(shell[m]), below = v + down_;
                if (!grid.contains(below + look) || !grid.contains(v - look) ||
                    !grid.contains(below - look) || !grid.contains(v + look))
                    continue;
                const double tagged = means.taggedHu.at(v);
                const double middle = 0.5 * (means.airHu.at(v.x, v.y, v.z) + tagged);
                const double here = scan.hu.at(v), next = scan.hu.at(below);
                if (here >= middle || next < middle) continue;
                double aside = 0.0;
                for (int axis = 0; axis < 3; ++axis) {
                    if (down_[axis] != 0) continue;
                    glm::ivec3 d(0);
                    d[axis] = look[axis];
                    const double rise = scan.hu.at(v + d) - scan.hu.at(v - d) +
                                        scan.hu.at(below + d) - scan.hu.at(below - d);
                    aside = std::max(aside, std::abs(rise) / (4.0 * look[axis] * spacing[axis]));
                }
                if (aside > steepest * (next - here) / stepMm_) continue;
                const glm::ivec3 nearer = middle - here < next - middle ? v : below;
                if (interfaces.bareness(nearer, tagged, means.softHu.at(v.x, v.y, v.z)) <
                    surelyBare)
                    continue;
                out[m] = std::uint8_t(1 + std::lround(254.0 * (middle - here) / (next - here)));
            }
        });
        for (std::size_t m = 0; m < shell.size(); ++m) {
            if (out[m] == 0) continue;
            const glm::ivec3 v = grid.voxelAt(shell[m]);
            found.push_back({columnOf(v), {v[vertical_], out[m] - 1}});
        }
    }
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
        return std::pair(a.column, a.crossing.height) < std::pair(b.column, b.crossing.height);
    });
    firstOfColumn_.assign(
        std::size_t(grid.size[across_[0]]) * std::size_t(grid.size[across_[1]]) + 1, 0);
    for (const Found& one : found) {
        crossings_.push_back(one.crossing);
        ++firstOfColumn_[one.column + 1];
    }
    std::partial_sum(firstOfColumn_.begin(), firstOfColumn_.end(), firstOfColumn_.begin());
    Grid coarse = grid;
    coarse.size = (grid.size + blockVoxels_ - 1) / blockVoxels_;
    blocks_ = Volume<std::uint8_t>(coarse, std::uint8_t(0));
    const auto block = blocks_.writable();
    for (const Found& one : found) {
        const auto length = std::size_t(grid.size[across_[0]]);
        glm::ivec3 v;
        v[vertical_] = one.crossing.height;
        v[across_[0]] = int(one.column % length), v[across_[1]] = int(one.column / length);
        const glm::ivec3 b = v / blockVoxels_;
        const glm::ivec3 reach = glm::ivec3(2) - glm::abs(down_);
        const glm::ivec3 lo = glm::max(b - reach, glm::ivec3(0)),
                         hi = glm::min(b + reach, coarse.size - 1);
        for (int k = lo.z; k <= hi.z; ++k) {
            for (int j = lo.y; j <= hi.y; ++j) {
                for (int i = lo.x; i <= hi.x; ++i)
                    block[coarse.index(i, j, k)] = 1;
            }
        }
    }
}

template <class Visit>
void WaterLevel::eachCrossing(glm::ivec3 voxel, double acrossMm, double heightMm,
                              const Visit& visit) const {
    const glm::ivec3 level = glm::ivec3(1) - glm::abs(down_);
    const int reach = voxelsIn(grid_, heightMm)[vertical_];
    eachStep(grid_, voxel, voxelsIn(grid_, acrossMm) * level, acrossStep_, [&](glm::ivec3 at) {
        const std::size_t column = columnOf(at);
        for (std::size_t n = firstOfColumn_[column]; n < firstOfColumn_[column + 1]; ++n) {
            at[vertical_] = crossings_[n].height;
            if (std::abs(at[vertical_] - voxel[vertical_]) <= reach) visit(at, crossings_[n]);
        }
    });
}

bool WaterLevel::standsAbove(glm::ivec3 voxel, const Volume<std::uint8_t>& segmentation) const {
    if (crossings_.empty()) return false;
    const int widestGap = std::max(1, int(std::lround(2.3 / stepMm_)));
    glm::ivec3 top = voxel;
    int gap = 0;
    for (glm::ivec3 v = voxel - down_; grid_.contains(v) && gap <= widestGap; v -= down_) {
        const LumenLabel label{segmentation.at(v)};
        if (label == LumenLabel::air) break;
        gap = label == LumenLabel::tagged ? 0 : gap + 1;
        if (gap == 0) top = v;
    }
    int count = 0;
    eachCrossing(top, acrossMm, 2.3, [&](glm::ivec3, const Crossing&) { ++count; });
    return count >= fewestColumns_;
}

std::optional<double> WaterLevel::depthMm(glm::ivec3 voxel) const {
    if (crossings_.empty()) return std::nullopt;
    const glm::dvec3 flatMm = glm::dvec3(glm::ivec3(1) - glm::abs(down_)) * grid_.spacingMm();
    double weight = 0.0, sum = 0.0;
    int count = 0;
    eachCrossing(voxel, acrossMm, heightMm, [&](glm::ivec3 at, const Crossing& crossing) {
        const glm::ivec3 d = at - voxel;
        const glm::dvec3 flat = glm::dvec3(d) * flatMm;
        const double w = 1.0 / (0.75 + glm::dot(flat, flat));
        // The voxel lies this far below the crossing, in voxels.
        sum += w * (-double(d.x * down_.x + d.y * down_.y + d.z * down_.z) - crossing.part / 254.0);
        weight += w, ++count;
    });
    if (count < fewestColumns_) return std::nullopt;
    return sum / weight * stepMm_;
}

}  // namespace haustra::cleansing
