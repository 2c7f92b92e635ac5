#include "topology/air_fluid.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

namespace haustra::topology {
namespace {

constexpr double thickestInterfaceMm = 2.6;  // of partial volume between air and fluid
constexpr int thinnestLayer = 2;             // voxels of air above, and of fluid below
constexpr double smallestLevelMm2 = 20.0;
constexpr std::uint16_t nobodys =
    std::numeric_limits<std::uint16_t>::max();  // owned, but open to no other pool
constexpr int deepestSample = 6;                // voxels below the surface that tell the fluid's HU

double softHu(const TissueModel& tissue) {
    return tissue.meanHu[int(Tissue::soft)];
}

// Columns of one slice across the third axis, found by walking down each line of the gravity axis.
std::vector<LevelColumn> columnsOfSlice(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                                        const RunComponents& air, const std::vector<char>& bowelAir,
                                        GravityAxis down, int k) {
    const Grid& grid = hu.grid();
    const int across = 1 - down.axis;
    const int length = grid.size[down.axis], width = grid.size[across];
    const double spacingMm = grid.spacingMm()[down.axis];
    const int longestGap = int(std::ceil(thickestInterfaceMm / spacingMm));
    struct State {
        int airRun = 0, airEnd = -1, gap = 0, fluidRun = 0, fluidBegin = -1;
        bool armed = false;
    };
    std::vector<State> states(static_cast<std::size_t>(width));
    std::vector<LevelColumn> columns;
    for (int step = 0; step < length; ++step) {
        const int at = down.sign > 0 ? step : length - 1 - step;
        glm::ivec3 v(0, 0, k);
        v[down.axis] = at;
        for (int n = 0; n < width; ++n) {
            v[across] = n;
            State& s = states[n];
            const int value = hu.at(v);
            if (value < tissue.airBelowHu) {
                s.airRun = s.armed && s.gap == 0 ? s.airRun + 1 : 1;
                s.armed = true, s.gap = 0, s.fluidRun = 0, s.airEnd = at;
            } else if (!s.armed) {
                continue;
            } else if (value > tissue.taggedAboveHu) {
                if (s.fluidRun++ == 0) s.fluidBegin = at;
                if (s.fluidRun < thinnestLayer) continue;
                s.armed = false;
                if (s.airRun < thinnestLayer) continue;
                LevelColumn column{v, v, 0};
                column.above[down.axis] = s.airEnd;
                column.below[down.axis] = s.fluidBegin;
                column.air = air.at(column.above);
                if (column.air >= 0 && bowelAir[column.air]) columns.push_back(column);
            } else if (s.fluidRun > 0 || ++s.gap > longestGap) {
                s.armed = false;
            }
        }
    }
    return columns;
}

// The columns of one patch that lie at its commonest height, if they are most of it: a level.
// A curved wall between gas and an opacified neighbour has no such height.
void keepIfFlat(const std::vector<LevelColumn>& patch, const Volume<std::int16_t>& hu,
                double taggedAboveHu, GravityAxis down, double columnMm2,
                std::vector<Level>& levels) {
    std::unordered_map<int, int> heights;
    for (const LevelColumn& c : patch)
        ++heights[c.below[down.axis]];
    int mode = 0, most = 0;
    for (const auto& [height, count] : heights) {
        const int around = count + (heights.count(height - 1) ? heights.at(height - 1) : 0) +
                           (heights.count(height + 1) ? heights.at(height + 1) : 0);
        if (around > most || (around == most && height < mode)) most = around, mode = height;
    }
    if (most * columnMm2 < smallestLevelMm2 || most < 0.5 * double(patch.size())) return;
    Level level;
    level.height = mode;
    std::vector<int> samples;
    for (const LevelColumn& c : patch) {
        if (std::abs(c.below[down.axis] - mode) > 1) continue;
        level.columns.push_back(c);
        glm::ivec3 v = c.below;
        for (int depth = 0; depth < deepestSample; ++depth, v[down.axis] += down.sign) {
            if (!hu.grid().contains(v) || hu.at(v) <= taggedAboveHu) break;
            if (depth > 0) samples.push_back(hu.at(v));
        }
    }
    if (samples.empty()) return;
    std::nth_element(samples.begin(), samples.begin() + samples.size() / 2, samples.end());
    level.fluidHu = samples[samples.size() / 2];
    level.areaMm2 = double(level.columns.size()) * columnMm2;
    levels.push_back(std::move(level));
}

// Places in the horizontal plane, one number each.
std::size_t placeOf(const Grid& grid, GravityAxis down, glm::ivec3 v) {
    const int across = 1 - down.axis;
    return std::size_t(v[across]) + std::size_t(grid.size[across]) * std::size_t(v.z);
}

std::unordered_map<std::size_t, int> surfaceOf(const Pool& pool, const std::vector<Level>& levels,
                                               const Grid& grid, GravityAxis down) {
    std::unordered_map<std::size_t, int> surface;
    for (int l : pool.levels) {
        for (const LevelColumn& c : levels[l].columns)
            surface[placeOf(grid, down, c.below)] = c.below[down.axis];
    }
    return surface;
}

// A pool fills a bay of the bowel: a fair part of it lies straight below its own surface. What has
// run through a thin wall into opacified bowel or bone does not.
bool standsUnder(const Pool& pool, const std::vector<Level>& levels, const Grid& grid,
                 GravityAxis down) {
    constexpr double smallestShare = 0.12;
    const auto surface = surfaceOf(pool, levels, grid, down);
    std::unordered_set<std::size_t> footprint;
    for (std::uint32_t index : pool.voxels)
        footprint.insert(placeOf(grid, down, grid.voxelAt(index)));
    return double(surface.size()) >= smallestShare * double(footprint.size());
}

// Only the fluid in an unbroken column below the surface.
void keepBelow(Pool& pool, const std::vector<Level>& levels, const Grid& grid, GravityAxis down,
               std::vector<std::uint16_t>& owner) {
    std::vector<std::uint32_t> kept;
    const std::unordered_set<std::uint32_t> all(pool.voxels.begin(), pool.voxels.end());
    for (const auto& [place, height] : surfaceOf(pool, levels, grid, down)) {
        glm::ivec3 v(0);
        v[1 - down.axis] = int(place % std::size_t(grid.size[1 - down.axis]));
        v.z = int(place / std::size_t(grid.size[1 - down.axis]));
        for (v[down.axis] = height; grid.contains(v); v[down.axis] += down.sign) {
            const std::uint32_t index = std::uint32_t(grid.index(v));
            if (!all.count(index)) break;
            kept.push_back(index);
        }
    }
    for (std::uint32_t index : pool.voxels)
        owner[index] = 0;
    for (std::uint32_t index : kept)
        owner[index] = nobodys;
    pool.voxels = std::move(kept);
    pool.touches.clear();
}

}  // namespace

std::vector<Level> findLevels(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                              const RunComponents& air, const std::vector<char>& bowelAir,
                              GravityAxis down, int threads) {
    const Grid& grid = hu.grid();
    std::vector<std::vector<LevelColumn>> slices(static_cast<std::size_t>(grid.size.z));
    parallelFor(slices.size(), 1, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            slices[k] = columnsOfSlice(hu, tissue, air, bowelAir, down, int(k));
        }
    });
    std::vector<LevelColumn> columns;
    for (const auto& slice : slices)
        columns.insert(columns.end(), slice.begin(), slice.end());

    // Patches: neighbours in the horizontal plane (8 of them) whose heights differ by at most one.
    const int across = 1 - down.axis;
    const std::size_t width = std::size_t(grid.size[across]);
    std::unordered_map<std::size_t, std::vector<int>> atPlace;
    for (std::size_t n = 0; n < columns.size(); ++n) {
        atPlace[std::size_t(columns[n].below[across]) + width * std::size_t(columns[n].below.z)]
            .push_back(int(n));
    }
    const glm::dvec3 spacing = grid.spacingMm();
    std::vector<char> visited(columns.size(), 0);
    std::vector<Level> levels;
    for (std::size_t seed = 0; seed < columns.size(); ++seed) {
        if (visited[seed]) continue;
        std::vector<int> queue{int(seed)};
        visited[seed] = 1;
        std::vector<LevelColumn> patch;
        for (std::size_t head = 0; head < queue.size(); ++head) {
            const LevelColumn& c = columns[queue[head]];
            patch.push_back(c);
            for (int dz = -1; dz <= 1; ++dz) {
                for (int dn = -1; dn <= 1; ++dn) {
                    const int n = c.below[across] + dn, z = c.below.z + dz;
                    if (n < 0 || z < 0 || n >= int(width) || z >= grid.size.z) continue;
                    const auto found = atPlace.find(std::size_t(n) + width * std::size_t(z));
                    if (found == atPlace.end()) continue;
                    for (int other : found->second) {
                        if (visited[other] ||
                            std::abs(columns[other].below[down.axis] - c.below[down.axis]) > 1)
                            continue;
                        visited[other] = 1;
                        queue.push_back(other);
                    }
                }
            }
        }
        keepIfFlat(patch, hu, tissue.taggedAboveHu, down, spacing[across] * spacing.z, levels);
    }
    return levels;
}

double totalAreaMm2(const std::vector<Level>& levels) {
    return std::accumulate(levels.begin(), levels.end(), 0.0,
                           [](double sum, const Level& level) { return sum + level.areaMm2; });
}

std::vector<Pool> floodPools(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                             const std::vector<Level>& levels, GravityAxis down) {
    constexpr double coreShare = 0.7, edgeShare = 0.5;  // of the way from soft tissue to the fluid
    constexpr int edgeVoxels = 2;
    const Grid& grid = hu.grid();
    const glm::ivec3 size = grid.size;
    const std::size_t strides[3] = {1, std::size_t(size.x),
                                    std::size_t(size.x) * std::size_t(size.y)};
    std::vector<std::uint16_t> owner(grid.voxelCount(), 0);  // pool number + 1
    const double soft = softHu(tissue);

    // Bright fluid first, so that a weakly tagged neighbour cannot claim it.
    std::vector<int> order(levels.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return levels[a].fluidHu > levels[b].fluidHu; });

    std::vector<Pool> pools;
    std::vector<double> cores;  // of each pool, the HU that it was grown through
    auto neighbours = [&](std::uint32_t index, auto&& visit) {
        const glm::ivec3 v = grid.voxelAt(index);
        for (int axis = 0; axis < 3; ++axis) {
            if (v[axis] > 0) visit(std::uint32_t(index - strides[axis]));
            if (v[axis] + 1 < size[axis]) visit(std::uint32_t(index + strides[axis]));
        }
    };
    for (int n : order) {
        const Level& level = levels[n];
        const double core =
            std::max(tissue.taggedAboveHu, soft + coreShare * (level.fluidHu - soft));
        const double edge = std::max(0.5 * (soft + tissue.taggedAboveHu),
                                     soft + edgeShare * (level.fluidHu - soft));
        // A level may stand on fluid that another level has claimed already.
        std::unordered_map<std::uint16_t, int> claimed;
        std::vector<std::uint32_t> queue;
        if (pools.size() + 1 >= nobodys) break;
        const std::uint16_t mine = std::uint16_t(pools.size() + 1);
        auto notAbove = [&](std::uint32_t index) {
            return (grid.voxelAt(index)[down.axis] - level.height) * down.sign >= -1;
        };
        for (const LevelColumn& c : level.columns) {
            for (int depth = 0; depth < deepestSample; ++depth) {
                glm::ivec3 v = c.below;
                v[down.axis] += depth * down.sign;
                if (!grid.contains(v)) break;
                const std::uint32_t index = std::uint32_t(grid.index(v));
                if (owner[index] != 0 && owner[index] != mine && owner[index] != nobodys)
                    ++claimed[owner[index]];
                if (owner[index] == 0 && hu[index] > core)
                    owner[index] = mine, queue.push_back(index);
            }
        }
        if (!claimed.empty()) {
            // Join the pool that most of the columns stand on (lowest number where several do).
            std::uint16_t joined = 0;
            int most = 0;
            for (const auto& [pool, count] : claimed) {
                if (count > most || (count == most && pool < joined)) joined = pool, most = count;
            }
            pools[joined - 1].levels.push_back(n);
            for (std::uint32_t index : queue) {
                owner[index] = joined;
                pools[joined - 1].voxels.push_back(index);
            }
            continue;
        }
        std::vector<int> touches;
        for (std::size_t head = 0; head < queue.size(); ++head) {
            neighbours(queue[head], [&](std::uint32_t next) {
                if (owner[next] == mine || owner[next] == nobodys || !(hu[next] > core)) return;
                if (owner[next] != 0) {
                    // One body of fluid only where neither would see a wall between them.
                    const double stricter = std::max(core, cores[owner[next] - 1]);
                    if (hu[next] < stricter || hu[queue[head]] < stricter) return;
                    if (touches.empty() || touches.back() != owner[next] - 1)
                        touches.push_back(owner[next] - 1);
                    return;
                }
                if (!notAbove(next)) return;
                owner[next] = mine;
                queue.push_back(next);
            });
        }
        std::size_t ring = 0;
        for (int layer = 0; layer < edgeVoxels; ++layer) {
            const std::size_t end = queue.size();
            for (std::size_t head = ring; head < end; ++head) {
                neighbours(queue[head], [&](std::uint32_t next) {
                    if (owner[next] != 0 || !(hu[next] > edge) || !notAbove(next)) return;
                    owner[next] = mine;
                    queue.push_back(next);
                });
            }
            ring = end;
        }
        Pool pool;
        pool.voxels = std::move(queue);
        std::sort(touches.begin(), touches.end());
        touches.erase(std::unique(touches.begin(), touches.end()), touches.end());
        pool.touches = std::move(touches);
        pool.levels.push_back(n);
        if (!standsUnder(pool, levels, grid, down)) keepBelow(pool, levels, grid, down, owner);
        pools.push_back(std::move(pool));
        cores.push_back(core);
    }
    for (Pool& pool : pools) {
        std::sort(pool.voxels.begin(), pool.voxels.end());
        double sum = 0.0;
        for (std::uint32_t index : pool.voxels)
            sum += hu[index];
        pool.meanHu = pool.voxels.empty() ? 0.0 : sum / double(pool.voxels.size());
    }
    return pools;
}

}  // namespace haustra::topology
