#include "topology/pools.h"

#include "topology/offshoots.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

namespace haustra::topology {
namespace {

constexpr double coreShare = 0.7, edgeShare = 0.5;  // of the way from soft tissue to the fluid
// Fluid wets the wall, and stands in its corners, higher than its level.
constexpr double climbMm = 5.0;
constexpr int rimVoxels = 2, edgeVoxels = 2;
constexpr int seedDepth = 6;  // voxels below the surface that a flood starts from
// Share of a pool's footprint that its own surface covers: over the first it cannot have leaked
// much, under the second it may well have, under the third it has.
constexpr double wholeShare = 0.6, doubtfulShare = 0.3, leakedShare = 0.12;
// A pool that loses more than the rest of this share to a flood without pinholes had leaked.
constexpr double pinholeShare = 0.9;

using Owner = std::uint16_t;                                 // pool number + 1; 0 is nobody
constexpr Owner closed = std::numeric_limits<Owner>::max();  // taken, but open to no other pool

class PoolFlood {
public:
    PoolFlood(const Volume<std::int16_t>& hu, const TissueModel& tissue,
              const std::vector<Level>& levels, GravityAxis down)
        : hu_(hu),
          tissue_(tissue),
          levels_(levels),
          down_(down),
          grid_(hu.grid()),
          climb_(std::max(1, int(std::lround(climbMm / grid_.spacingMm()[down.axis])))),
          owner_(grid_.voxelCount(), 0) {}

    std::vector<Pool> run() {
        // Bright fluid first, so that a weakly tagged neighbour cannot claim it.
        std::vector<int> order(levels_.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(),
                         [&](int a, int b) { return levels_[a].fluidHu > levels_[b].fluidHu; });
        for (int level : order) {
            if (pools_.size() + 1 >= closed) break;
            if (!joinClaimed(level)) flood(level);
        }
        for (std::size_t p = 0; p < pools_.size(); ++p)
            climb(Owner(p + 1));
        for (Pool& pool : pools_) {
            std::sort(pool.voxels.begin(), pool.voxels.end());
            double sum = 0.0;
            for (std::uint32_t index : pool.voxels)
                sum += hu_[index];
            pool.meanHu = pool.voxels.empty() ? 0.0 : sum / double(pool.voxels.size());
        }
        return std::move(pools_);
    }

private:
    double soft() const { return tissue_.meanHu[int(Tissue::soft)]; }
    double coreHu(const Level& level) const {
        return std::max(tissue_.taggedAboveHu, soft() + coreShare * (level.fluidHu - soft()));
    }
    double edgeHu(const Level& level) const {
        return std::max(0.5 * (soft() + tissue_.taggedAboveHu),
                        soft() + edgeShare * (level.fluidHu - soft()));
    }
    /// Not more than `voxels` above the level.
    bool notAbove(std::uint32_t index, const Level& level, int voxels = 1) const {
        return (grid_.voxelAt(index)[down_.axis] - level.height) * down_.sign >= -voxels;
    }

    template <class Visit>
    void neighbours(std::uint32_t index, Visit&& visit) const {
        const std::size_t strides[3] = {1, std::size_t(grid_.size.x),
                                        std::size_t(grid_.size.x) * std::size_t(grid_.size.y)};
        const glm::ivec3 v = grid_.voxelAt(index);
        for (int axis = 0; axis < 3; ++axis) {
            if (v[axis] > 0) visit(std::uint32_t(index - strides[axis]));
            if (v[axis] + 1 < grid_.size[axis]) visit(std::uint32_t(index + strides[axis]));
        }
    }
    bool fluidAllAround(std::uint32_t index, double core) const {
        int fluid = 0;
        neighbours(index, [&](std::uint32_t next) { fluid += hu_[next] > core; });
        return fluid == 6;
    }

    template <class Visit>
    void columnsBelow(const Level& level, Visit&& visit) const {
        for (const LevelColumn& c : level.columns) {
            glm::ivec3 v = c.below;
            for (int depth = 0; depth < seedDepth && grid_.contains(v); ++depth) {
                visit(std::uint32_t(grid_.index(v)));
                v[down_.axis] += down_.sign;
            }
        }
    }

    // Whether the level stands on fluid that an earlier level has flooded; then it belongs to the
    // pool that most of it stands on (the earliest where several do).
    bool joinClaimed(int number) {
        std::unordered_map<Owner, int> claimed;
        columnsBelow(levels_[number], [&](std::uint32_t index) {
            if (owner_[index] != 0 && owner_[index] != closed) ++claimed[owner_[index]];
        });
        if (claimed.empty()) return false;
        Owner joined = 0;
        int most = 0;
        for (const auto& [pool, count] : claimed) {
            if (count > most || (count == most && pool < joined)) joined = pool, most = count;
        }
        pools_[joined - 1].levels.push_back(number);
        columnsBelow(levels_[number], [&](std::uint32_t index) {
            if (owner_[index] != 0 || !(hu_[index] > coreHu(levels_[number]))) return;
            owner_[index] = joined;
            pools_[joined - 1].voxels.push_back(index);
        });
        return true;
    }

    void flood(int number) {
        const Level& level = levels_[number];
        Pool pool = grow(level, false);
        const double covered = coveredShare(pool, level, false);
        if (covered < wholeShare) {
            // What a pinhole let in is cut off where a flood must have fluid all around.
            release(pool);
            Pool deep = grow(level, true);
            if (covered < doubtfulShare ||
                double(deep.voxels.size()) < pinholeShare * double(pool.voxels.size())) {
                pool = std::move(deep);
            } else {
                release(deep);
                const Owner mine = Owner(pools_.size() + 1);
                for (std::uint32_t index : pool.voxels)
                    owner_[index] = mine;
            }
        }
        if (covered < wholeShare && coveredShare(pool, level, true) < leakedShare)
            keepBelow(pool, level);
        dropOffshoots(pool, level);
        pool.levels = {number};
        pools_.push_back(std::move(pool));
        cores_.push_back(coreHu(level));
    }

    Pool grow(const Level& level, bool deepOnly) {
        const double core = coreHu(level), edge = edgeHu(level);
        const Owner mine = Owner(pools_.size() + 1);
        Pool pool;
        std::vector<std::uint32_t>& queue = pool.voxels;
        auto take = [&](std::uint32_t index) {
            owner_[index] = mine;
            queue.push_back(index);
        };
        columnsBelow(level, [&](std::uint32_t index) {
            if (owner_[index] == 0 && hu_[index] > core) take(index);
        });
        for (std::size_t head = 0; head < queue.size(); ++head) {
            const std::uint32_t here = queue[head];
            neighbours(here, [&](std::uint32_t next) {
                if (owner_[next] == mine || owner_[next] == closed || !(hu_[next] > core)) return;
                if (owner_[next] != 0) {
                    // One body of fluid only where neither would see a wall between them.
                    const int other = owner_[next] - 1;
                    const double stricter = std::max(core, cores_[other]);
                    if (hu_[next] >= stricter && hu_[here] >= stricter)
                        pool.touches.push_back(other);
                    return;
                }
                if (notAbove(next, level) && (!deepOnly || fluidAllAround(next, core))) take(next);
            });
        }
        std::sort(pool.touches.begin(), pool.touches.end());
        pool.touches.erase(std::unique(pool.touches.begin(), pool.touches.end()),
                           pool.touches.end());
        std::size_t ring = 0;
        for (int layer = deepOnly ? 0 : rimVoxels; layer < rimVoxels + edgeVoxels; ++layer) {
            const double least = layer < rimVoxels ? core : edge;
            const std::size_t end = queue.size();
            for (std::size_t head = ring; head < end; ++head) {
                neighbours(queue[head], [&](std::uint32_t next) {
                    if (owner_[next] == 0 && hu_[next] > least && notAbove(next, level)) take(next);
                });
            }
            ring = end;
        }
        return pool;
    }

    void release(const Pool& pool) {
        for (std::uint32_t index : pool.voxels)
            owner_[index] = 0;
    }

    // What is dropped stays closed to later pools of the same fluid.
    void dropOffshoots(Pool& pool, const Level& level) {
        std::sort(pool.voxels.begin(), pool.voxels.end());
        const std::vector<std::uint32_t> dull =
            dullOffshoots(hu_, pool.voxels, soft(), level.fluidHu);
        std::vector<std::uint32_t> kept;
        std::set_difference(pool.voxels.begin(), pool.voxels.end(), dull.begin(), dull.end(),
                            std::back_inserter(kept));
        for (std::uint32_t index : dull)
            owner_[index] = closed;
        pool.voxels = std::move(kept);
    }

    // Takes in the fluid that stands above the level, along the wall and in corners. Last of all,
    // so that no pool claims the fluid under another's level.
    void climb(Owner mine) {
        Pool& pool = pools_[mine - 1];
        const double core = cores_[mine - 1];
        const Level& level = levels_[pool.levels.front()];
        std::size_t ring = 0;
        for (int layer = 0; layer < climb_; ++layer) {
            const std::size_t end = pool.voxels.size();
            for (std::size_t head = ring; head < end; ++head) {
                if (notAbove(pool.voxels[head], level, -2)) continue;
                neighbours(pool.voxels[head], [&](std::uint32_t next) {
                    if (owner_[next] != 0 || !(hu_[next] > core)) return;
                    if (notAbove(next, level, 1) || !notAbove(next, level, climb_)) return;
                    owner_[next] = mine;
                    pool.voxels.push_back(next);
                });
            }
            ring = end;
        }
    }

    // Places in the horizontal plane, one number each.
    std::size_t placeOf(glm::ivec3 v) const {
        const int across = 1 - down_.axis;
        return std::size_t(v[across]) + std::size_t(grid_.size[across]) * std::size_t(v.z);
    }

    // A pool fills a bay of the bowel: a fair part of it lies straight below its own surface. What
    // has run through a thin wall into opacified bowel or bone does not.
    double coveredShare(const Pool& pool, const Level& level, bool allLevels) const {
        std::unordered_set<std::size_t> surface, footprint;
        for (const LevelColumn& c : level.columns)
            surface.insert(placeOf(c.below));
        // Folds that reach down to the fluid part its surface: each bay's level is some of it.
        if (allLevels) {
            const Owner mine = Owner(pools_.size() + 1);
            for (const Level& other : levels_) {
                columnsBelow(other, [&](std::uint32_t index) {
                    if (owner_[index] == mine) surface.insert(placeOf(grid_.voxelAt(index)));
                });
            }
        }
        for (std::uint32_t index : pool.voxels)
            footprint.insert(placeOf(grid_.voxelAt(index)));
        return double(surface.size()) / double(std::max<std::size_t>(1, footprint.size()));
    }

    // Only the fluid in an unbroken column below the surface.
    void keepBelow(Pool& pool, const Level& level) {
        std::vector<std::uint32_t> kept;
        const Owner mine = Owner(pools_.size() + 1);
        for (const LevelColumn& c : level.columns) {
            for (glm::ivec3 v = c.below; grid_.contains(v); v[down_.axis] += down_.sign) {
                const std::uint32_t index = std::uint32_t(grid_.index(v));
                if (owner_[index] != mine) break;
                owner_[index] = closed;
                kept.push_back(index);
            }
        }
        for (std::uint32_t index : pool.voxels) {
            if (owner_[index] == mine) owner_[index] = 0;
        }
        pool.voxels = std::move(kept);
        pool.touches.clear();
    }

    const Volume<std::int16_t>& hu_;
    const TissueModel& tissue_;
    const std::vector<Level>& levels_;
    const GravityAxis down_;
    const Grid grid_;
    const int climb_;
    std::vector<Owner> owner_;
    std::vector<Pool> pools_;
    std::vector<double> cores_;  // of each pool, the HU that it was grown through
};

}  // namespace

std::vector<Pool> floodPools(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                             const std::vector<Level>& levels, GravityAxis down) {
    return PoolFlood(hu, tissue, levels, down).run();
}

}  // namespace haustra::topology
