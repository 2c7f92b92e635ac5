#include "segmentation/air_fluid_levels.h"

#include "core/flood_fill.h"
#include "core/parallel.h"
#include "core/quantile.h"
#include "segmentation/bowel_contents.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace haustra::segmentation {
namespace {

constexpr double thickestInterfaceMm = 2.6;  // of partial volume between air and fluid
constexpr int thinnestLayer = 2;             // voxels of air above, and of fluid below
constexpr double smallestLevelMm2 = 20.0;
constexpr double offHeightMm = 0.6;  // of a column from its level
constexpr double otherFluid = 0.55;  // of a level's fluid's HU over soft tissue
constexpr double roughestMm = 0.4;   // fluid at rest is flat; a wall is not
constexpr int deepestSample = 6;     // voxels below the surface that tell the fluid's HU

// Columns of one slice across the third axis, found by walking down each line of the gravity axis.
std::vector<LevelColumn> columnsOfSlice(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                                        const Volume<std::uint8_t>& content, GravityAxis down,
                                        int k) {
    const Grid& grid = hu.grid();
    const int across = 1 - down.axis;
    const int length = grid.size[down.axis], width = grid.size[across];
    const double spacingMm = grid.spacingMm()[down.axis];
    const int longestGap = int(std::ceil(thickestInterfaceMm / spacingMm));
    struct State {
        int airRun = 0, airEnd = -1, gap = 0, fluidRun = 0, fluidBegin = -1;
        bool armed = false;
    };
    const int airBelowHu = int(std::ceil(tissue.airBelowHu)),
              taggedAboveHu = int(std::floor(tissue.taggedAboveHu));
    std::vector<LevelColumn> columns;
    const auto pass = [&](State& s, int n, int at, int value) {
        if (value < airBelowHu) {
            s.airRun = s.armed && s.gap == 0 ? s.airRun + 1 : 1;
            s.armed = true, s.gap = 0, s.fluidRun = 0, s.airEnd = at;
        } else if (!s.armed) {
            return;
        } else if (value > taggedAboveHu) {
            if (s.fluidRun++ == 0) s.fluidBegin = at;
            if (s.fluidRun < thinnestLayer) return;
            s.armed = false;
            if (s.airRun < thinnestLayer) return;
            LevelColumn column{glm::ivec3(k), glm::ivec3(k)};
            column.above[across] = column.below[across] = n;
            column.above[down.axis] = s.airEnd;
            column.below[down.axis] = s.fluidBegin;
            if (Content(content.at(column.above)) == Content::gas) columns.push_back(column);
        } else if (s.fluidRun > 0 || ++s.gap > longestGap) {
            s.armed = false;
        }
    };
    const auto atOf = [&](int step) { return down.sign > 0 ? step : length - 1 - step; };
    // In the order of memory, whichever way down is.
    const std::int16_t* const slice = &hu.voxels()[grid.index(0, 0, k)];
    if (down.axis == 0) {
        for (int n = 0; n < width; ++n) {
            const std::int16_t* const row = slice + std::ptrdiff_t(n) * grid.size.x;
            State state;
            for (int step = 0; step < length; ++step)
                pass(state, n, atOf(step), row[atOf(step)]);
        }
    } else {
        std::vector<State> states(static_cast<std::size_t>(width));
        for (int step = 0; step < length; ++step) {
            const std::int16_t* const row = slice + std::ptrdiff_t(atOf(step)) * grid.size.x;
            for (int n = 0; n < width; ++n)
                pass(states[std::size_t(n)], n, atOf(step), row[n]);
        }
    }
    return columns;
}

double medianOrZero(std::vector<double>& values) {
    return values.empty() ? 0.0 : medianOf(values);
}

/// Where HU first rises above `value` on the way down from a column's gas, in voxels from there.
double crossing(const Volume<std::int16_t>& hu, const LevelColumn& column, GravityAxis down,
                double value) {
    glm::ivec3 v = column.above;
    double last = hu.at(v);
    for (int step = 1; step < 12; ++step) {
        v[down.axis] += down.sign;
        if (!hu.grid().contains(v)) break;
        const double here = hu.at(v);
        if (here > value) return step - 1 + std::clamp((value - last) / (here - last), 0.0, 1.0);
        last = here;
    }
    return 12.0;
}

/// Median HU of the first voxels of a column's fluid.
double fluidUnder(const Volume<std::int16_t>& hu, const LevelColumn& column, GravityAxis down,
                  double taggedAboveHu) {
    std::vector<double> values;
    glm::ivec3 v = column.below;
    for (int depth = 0; depth < deepestSample; ++depth, v[down.axis] += down.sign) {
        if (!hu.grid().contains(v) || hu.at(v) <= taggedAboveHu) break;
        if (depth > 0) values.push_back(hu.at(v));
    }
    return values.empty() ? double(hu.at(column.below)) : medianOrZero(values);
}

/// Height, roughness and step of a level's surface, to a fraction of a voxel; columns of another
/// height or over another fluid are not its own.
void measureSurface(Level& level, const Volume<std::int16_t>& hu, const TissueModel& tissue,
                    GravityAxis down) {
    const double gas = tissue.meanHu[int(Tissue::air)], soft = tissue.meanHu[int(Tissue::soft)];
    const double voxelMm = hu.grid().spacingMm()[down.axis];
    std::vector<double> heights, steps, tops, rises;
    for (const LevelColumn& c : level.columns) {
        const double middle = crossing(hu, c, down, 0.5 * (gas + level.fluidHu));
        heights.push_back(voxelMm * (down.heightOf(c.above) + down.sign * middle));
        // From above the gas' own edge: the column's gas ends at that very HU.
        LevelColumn from = c;
        from.above[down.axis] -= down.sign;
        if (!hu.grid().contains(from.above)) continue;
        const double top = crossing(hu, from, down, soft - 0.25 * (soft - gas));
        steps.push_back(voxelMm * (crossing(hu, from, down, 0.5 * (soft + level.fluidHu)) - top));
        tops.push_back(voxelMm * (down.heightOf(from.above) + down.sign * top));
        rises.push_back(riseMm(hu, tissue, c.above, down));
    }
    std::vector<double> sorted = heights;
    level.heightMm = medianOrZero(sorted);
    level.stepMm = medianOrZero(steps);
    std::vector<double> topsSorted = tops;
    const double topMm = medianOrZero(topsSorted);
    for (double& top : tops)
        top = std::abs(top - topMm);
    level.topRoughnessMm = medianOrZero(tops);
    level.riseMm = medianOrZero(rises);
    const double mostOffMm = std::max(offHeightMm, 0.5 * voxelMm);
    const double contrast = level.fluidHu - soft;
    std::vector<LevelColumn> own;
    for (std::size_t n = 0; n < heights.size(); ++n) {
        heights[n] = std::abs(heights[n] - level.heightMm);
        if (heights[n] > mostOffMm) continue;
        const double ratio =
            (fluidUnder(hu, level.columns[n], down, tissue.taggedAboveHu) - soft) / contrast;
        if (ratio < otherFluid || ratio > 1.0 / otherFluid) continue;
        own.push_back(level.columns[n]);
    }
    level.roughnessMm = medianOrZero(heights);
    level.columns = std::move(own);
}

// The columns of one patch that lie at its commonest height, if they are most of it: a level.
// A curved wall between gas and an opacified neighbour has no such height.
void keepIfFlat(const std::vector<LevelColumn>& patch, const Volume<std::int16_t>& hu,
                const TissueModel& tissue, GravityAxis down, double columnMm2,
                std::vector<Level>& levels) {
    std::unordered_map<int, int> heights;
    const auto heightOf = [&](const LevelColumn& c) {
        return int(std::lround(down.heightOf(c.below)));
    };
    for (const LevelColumn& c : patch)
        ++heights[heightOf(c)];
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
        if (std::abs(heightOf(c) - mode) > 1) continue;
        level.columns.push_back(c);
        glm::ivec3 v = c.below;
        for (int depth = 0; depth < deepestSample; ++depth, v[down.axis] += down.sign) {
            if (!hu.grid().contains(v) || hu.at(v) <= tissue.taggedAboveHu) break;
            if (depth > 0) samples.push_back(hu.at(v));
        }
    }
    if (samples.empty()) return;
    level.fluidHu = medianOf(samples);
    measureSurface(level, hu, tissue, down);
    level.areaMm2 = double(level.columns.size()) * columnMm2;
    if (level.roughnessMm > roughestMm || level.areaMm2 < smallestLevelMm2) return;
    levels.push_back(std::move(level));
}

constexpr int flatVoxels = 3, widestEdge = 6;  // of gas and of tissue; of what lies between

/// The middle half of the way from gas to soft tissue.
struct MiddleHalf {
    double softHu, fromHu, toHu;

    explicit MiddleHalf(const TissueModel& tissue) : softHu(tissue.meanHu[int(Tissue::soft)]) {
        const double gas = tissue.meanHu[int(Tissue::air)];
        fromHu = gas + 0.25 * (softHu - gas), toHu = gas + 0.75 * (softHu - gas);
    }

    /// How many steps a line takes over it from `first` on, the first beyond gas. Empty where it
    /// falls, or does not end in soft tissue.
    template <class HuAt>
    std::optional<double> steps(int first, const HuAt& huAt) const {
        constexpr double nearHu = 80.0;
        std::optional<double> from;
        for (int step = first; step < first + widestEdge; ++step) {
            const double last = huAt(step - 1), here = huAt(step);
            if (here <= last) return std::nullopt;
            const auto reached = [&](double hu) { return step + (hu - last) / (here - last); };
            if (!from && here > fromHu) from = reached(fromHu);
            if (here <= toHu) continue;
            for (int more = 1; more <= flatVoxels; ++more)
                if (std::abs(huAt(step + more) - softHu) > nearHu) return std::nullopt;
            return reached(toHu) - *from;
        }
        return std::nullopt;
    }
};

}  // namespace

double meanAlongLevel(const Volume<std::int16_t>& hu, glm::ivec3 v, GravityAxis down) {
    int sum = 0, count = 0;
    for (int d = 0; d < 9; ++d) {
        glm::ivec3 beside = v;
        beside[1 - down.axis] += d % 3 - 1, beside.z += d / 3 - 1;
        if (hu.grid().contains(beside)) sum += hu.at(beside), ++count;
    }
    return double(sum) / count;
}

double riseMm(const Volume<std::int16_t>& hu, const TissueModel& tissue, glm::ivec3 from,
              GravityAxis down) {
    constexpr double wallHu = 20.0, share = 0.75;
    const double leastHu = tissue.meanHu[int(Tissue::soft)] + wallHu,
                 voxelMm = hu.grid().spacingMm()[down.axis];
    std::vector<double> means;
    for (double mm = 0.0; mm <= longestGradientMm && hu.grid().contains(from); mm += voxelMm) {
        means.push_back(meanAlongLevel(hu, from, down));
        from[down.axis] += down.sign;
    }
    if (means.empty()) return 0.0;
    const std::size_t peak = std::size_t(std::ranges::max_element(means) - means.begin());
    const auto lastPast = [&](double value) {
        for (std::size_t at = peak; at > 0; --at)
            if (means[at - 1] <= value)
                return double(at) - (means[at] - value) / (means[at] - means[at - 1]);
        return 0.0;
    };
    return voxelMm * std::max(0.0, lastPast(share * means[peak]) - lastPast(leastHu));
}

std::vector<Level> findLevels(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                              const Volume<std::uint8_t>& content, GravityAxis down, int threads) {
    const Grid& grid = hu.grid();
    std::vector<std::vector<LevelColumn>> slices(static_cast<std::size_t>(grid.size.z));
    parallelFor(slices.size(), 1, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            slices[k] = columnsOfSlice(hu, tissue, content, down, int(k));
        }
    });
    std::vector<LevelColumn> columns;
    for (const auto& slice : slices)
        columns.insert(columns.end(), slice.begin(), slice.end());

    // Patches: neighbours in the horizontal plane (8 of them) whose heights differ by at most one.
    const int across = 1 - down.axis;
    // Of an oblique grid a plane's columns are whole voxels, off it by half of one.
    const double mostStep = down.slope == glm::dvec2(0.0) ? 1.0 : 1.5;
    const std::size_t width = std::size_t(grid.size[across]);
    std::unordered_map<std::size_t, std::vector<int>> atPlace;
    for (std::size_t n = 0; n < columns.size(); ++n) {
        atPlace[std::size_t(columns[n].below[across]) + width * std::size_t(columns[n].below.z)]
            .push_back(int(n));
    }
    const auto visitAround = [&](int column, const auto& visit) {
        const LevelColumn& c = columns[std::size_t(column)];
        for (int d = 0; d < 9; ++d) {
            const int n = c.below[across] + d % 3 - 1, z = c.below.z + d / 3 - 1;
            if (n < 0 || z < 0 || n >= int(width) || z >= grid.size.z) continue;
            const auto found = atPlace.find(std::size_t(n) + width * std::size_t(z));
            if (found == atPlace.end()) continue;
            for (const int other : found->second) {
                const double height = down.heightOf(columns[std::size_t(other)].below);
                if (std::abs(height - down.heightOf(c.below)) <= mostStep) visit(other);
            }
        }
    };
    const glm::dvec3 spacing = grid.spacingMm();
    // Of the level plane, which lies aslant in an oblique grid.
    const glm::dvec2 climb =
        spacing[down.axis] * down.slope / glm::dvec2(spacing[across], spacing.z);
    const double columnMm2 = spacing[across] * spacing.z * std::sqrt(1.0 + glm::dot(climb, climb));
    std::vector<char> visited(columns.size(), 0);
    std::vector<Level> levels;
    for (std::size_t seed = 0; seed < columns.size(); ++seed) {
        if (visited[seed]) continue;
        std::vector<int> members{int(seed)};
        visited[seed] = 1;
        floodFill(members, visitAround, [&](int other) {
            if (visited[std::size_t(other)]) return false;
            visited[std::size_t(other)] = 1;
            return true;
        });
        std::vector<LevelColumn> patch;
        for (const int n : members)
            patch.push_back(columns[std::size_t(n)]);
        keepIfFlat(patch, hu, tissue, down, columnMm2, levels);
    }
    return levels;
}

std::optional<double> edgeWidthMm(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                                  const Volume<std::uint8_t>& content, int axis) {
    constexpr std::size_t leastEdges = 100;
    const Grid& grid = hu.grid();
    const MiddleHalf middle(tissue);
    // Some lines are enough.
    const int slices = std::max(1, grid.size.z / 64),
              lines = std::max(1, grid.size[1 - axis] / 128), length = grid.size[axis];
    std::vector<double> widths;
    for (int k = 0; k < grid.size.z; k += slices) {
        for (int n = 0; n < grid.size[1 - axis]; n += lines) {
            for (const int sign : {-1, 1}) {
                const auto voxel = [&](int step) {
                    glm::ivec3 v(0, 0, k);
                    v[1 - axis] = n, v[axis] = sign > 0 ? step : length - 1 - step;
                    return grid.index(v);
                };
                int run = 0;
                for (int step = 0; step + widestEdge + flatVoxels < length; ++step) {
                    const bool isGas = Content(content[voxel(step)]) == Content::gas &&
                                       hu[voxel(step)] < middle.fromHu;
                    if (isGas)
                        ++run;
                    else if (std::exchange(run, 0) >= flatVoxels)
                        if (const auto steps =
                                middle.steps(step, [&](int at) { return double(hu[voxel(at)]); }))
                            widths.push_back(*steps * grid.spacingMm()[axis]);
                }
            }
        }
    }
    if (widths.size() < leastEdges) return std::nullopt;
    return medianOf(widths);
}

}  // namespace haustra::segmentation
