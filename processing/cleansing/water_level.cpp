#include "cleansing/water_level.h"

#include "cleansing/ball.h"
#include "core/voxel_sweep.h"

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

/// Where a level crosses the way from a voxel to the one below it.
class Crossings {
public:
    Crossings(const CtScan& scan, const LocalMeans& means, const InterfaceLayer& interfaces,
              glm::ivec3 down, double stepMm)
        : hu_(scan.hu),
          grid_(scan.hu.grid()),
          means_(means),
          interfaces_(interfaces),
          down_(down),
          stepMm_(stepMm),
          look_(neighbourStep(grid_)),
          spacingMm_(grid_.spacingMm()) {}

    /// 0 where it does not cross, else 1 + 254 f where it does f of the way.
    std::uint8_t below(glm::ivec3 v) const {
        const glm::ivec3 below = v + down_;
        if (!grid_.contains(below + look_) || !grid_.contains(v - look_) ||
            !grid_.contains(below - look_) || !grid_.contains(v + look_))
            return 0;
        const double tagged = means_.taggedHu.at(v);
        const double middle = 0.5 * (means_.airHu.at(v.x, v.y, v.z) + tagged);
        const double here = hu_.at(v), next = hu_.at(below);
        if (here >= middle || next < middle) return 0;
        if (slopeAside(v, below) > steepest * (next - here) / stepMm_) return 0;
        const glm::ivec3 nearer = middle - here < next - middle ? v : below;
        if (interfaces_.bareness(nearer, tagged, means_.softHu.at(v.x, v.y, v.z)) < surelyBare)
            return 0;
        return std::uint8_t(1 + std::lround(254.0 * (middle - here) / (next - here)));
    }

private:
    // A steeper surface is no level, or a wall's blur has tilted it.
    static constexpr double steepest = 0.12, surelyBare = 0.9;

    /// HU per mm, along the horizontal axis where it is the most.
    double slopeAside(glm::ivec3 v, glm::ivec3 below) const {
        double most = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            if (down_[axis] != 0) continue;
            glm::ivec3 d(0);
            d[axis] = look_[axis];
            const double rise =
                hu_.at(v + d) - hu_.at(v - d) + hu_.at(below + d) - hu_.at(below - d);
            most = std::max(most, std::abs(rise) / (4.0 * look_[axis] * spacingMm_[axis]));
        }
        return most;
    }

    const Volume<std::int16_t>& hu_;
    const Grid& grid_;
    const LocalMeans& means_;
    const InterfaceLayer& interfaces_;
    const glm::ivec3 down_;
    const double stepMm_;
    const glm::ivec3 look_;
    const glm::dvec3 spacingMm_;
};

}  // namespace

WaterLevel::WaterLevel(const CtScan& scan, const LocalMeans& means,
                       const InterfaceLayer& interfaces, const TaggedSurroundings& around,
                       glm::dvec3 gravity, int threads)
    : grid_(scan.hu.grid()) {
    findAxes(gravity);
    if (down_ == glm::ivec3(0)) return;
    const Crossings look(scan, means, interfaces, down_, stepMm_);
    std::vector<Found> found;
    for (const auto& shell : around.shells) {
        std::vector<std::uint8_t> parts(shell.size(), 0);
        parallelFor(shell.size(), 1 << 13, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m)
                parts[m] = look.below(grid_.voxelAt(shell[m]));
        });
        for (std::size_t m = 0; m < shell.size(); ++m) {
            if (parts[m] == 0) continue;
            const glm::ivec3 v = grid_.voxelAt(shell[m]);
            found.push_back({columnOf(v), {v[vertical_], parts[m] - 1}});
        }
    }
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
        return std::pair(a.column, a.crossing.height) < std::pair(b.column, b.crossing.height);
    });
    keep(found);
    markBlocks(found);
}

void WaterLevel::findAxes(glm::dvec3 gravity) {
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 direction = glm::normalize(glm::dvec3(grid_.patientFromVoxel[axis]));
        const double along = glm::dot(direction, gravity);
        if (std::abs(along) < 0.95) continue;
        down_[axis] = along > 0.0 ? 1 : -1;
        stepMm_ = grid_.spacingMm()[axis];
        vertical_ = axis;
    }
    across_ = {vertical_ == 0 ? 1 : 0, vertical_ == 2 ? 1 : 2};
    acrossStep_ = glm::max(neighbourStep(grid_) * (glm::ivec3(1) - glm::abs(down_)), glm::ivec3(1));
    fewestColumns_ = smallestMm2 * stepMm_ / grid_.voxelVolumeMm3() /
                     (acrossStep_.x * acrossStep_.y * acrossStep_.z);
    blockVoxels_ = voxelsIn(grid_, heightMm);
}

void WaterLevel::keep(const std::vector<Found>& sorted) {
    firstOfColumn_.assign(
        std::size_t(grid_.size[across_[0]]) * std::size_t(grid_.size[across_[1]]) + 1, 0);
    for (const Found& one : sorted) {
        crossings_.push_back(one.crossing);
        ++firstOfColumn_[one.column + 1];
    }
    std::partial_sum(firstOfColumn_.begin(), firstOfColumn_.end(), firstOfColumn_.begin());
}

void WaterLevel::markBlocks(const std::vector<Found>& found) {
    Grid coarse = grid_;
    coarse.size = (grid_.size + blockVoxels_ - 1) / blockVoxels_;
    blocks_ = Volume<std::uint8_t>(coarse, std::uint8_t(0));
    const auto block = blocks_.writable();
    const auto length = std::size_t(grid_.size[across_[0]]);
    const glm::ivec3 reach = glm::ivec3(2) - glm::abs(down_);
    for (const Found& one : found) {
        glm::ivec3 v;
        v[vertical_] = one.crossing.height;
        v[across_[0]] = int(one.column % length), v[across_[1]] = int(one.column / length);
        const glm::ivec3 b = v / blockVoxels_;
        visitBox(glm::max(b - reach, glm::ivec3(0)), glm::min(b + reach, coarse.size - 1),
                 [&](glm::ivec3 near) { block[coarse.index(near)] = 1; });
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
