#include "cleansing/pseudo_enhancement.h"

#include "cleansing/ball.h"
#include "cleansing/near_blocks.h"
#include "cleansing/noise.h"
#include "core/normal_distribution.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace haustra::cleansing {
namespace {

constexpr std::array<double, 5> widthsMm = {8.0, 12.0, 16.0, 24.0, 32.0};
constexpr double excessCellMm = 3.0;          // in the slice
constexpr double enhancementSampleMm3 = 4.0;  // one voxel of so much is looked at
constexpr double leastEdgeHu = 4.0;
constexpr double fewestSamples = 500.0;
constexpr double wallMm = 1.5;  // so deep beyond the blur what is around the lumen is looked at
constexpr double wallSlabMm = 20.0;  // what surrounds the colon there is taken as independent
constexpr double mostOfContrast = 1.0 / 3.0;  // of contents over soft tissue, for their own gain
// Of the HU that count as wall: fat's do, gas' and cortical bone's do not.
constexpr double belowSoftHu = 250.0, aboveSoftHu = 200.0;

glm::ivec3 excessCell(const Grid& grid) {
    glm::ivec3 perCell = voxelsIn(grid, excessCellMm);
    perCell.z = 1;
    return perCell;
}

/// The tagging's excess over gas, in cells of one slice each, over all of `field`, whose voxel
/// `from` is the scan's first.
SmoothField excessOf(const CtScan& scan, const Volume<std::uint8_t>& segmentation, double airHu,
                     const Grid& field, glm::ivec3 from, int threads) {
    const Grid& grid = scan.hu.grid();
    const glm::ivec3 perCell = excessCell(grid);
    SmoothField excess(field, perCell);
    std::vector<float>& values = excess.values();
    const float share = 1.0f / float(perCell.x * perCell.y);
    parallelFor(std::size_t(grid.size.z), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (int k = int(begin); k < int(end); ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                for (int i = 0; i < grid.size.x; ++i) {
                    if (LumenLabel(segmentation.at(i, j, k)) == LumenLabel::tagged)
                        values[excess.cellOf(i + from.x, j + from.y, k + from.z)] +=
                            share * std::max(0.0f, float(scan.hu.at(i, j, k) - airHu));
                }
            }
        }
    });
    return excess;
}

/// A Gaussian whose weights sum to 1.
std::vector<float> unitGaussian(double sigmaCells) {
    const int reach = int(std::ceil(3.0 * sigmaCells));
    std::vector<float> kernel;
    float sum = 0.0f;
    for (int r = -reach; r <= reach; ++r) {
        kernel.push_back(float(std::exp(-0.5 * r * r / (sigmaCells * sigmaCells))));
        sum += kernel.back();
    }
    for (float& w : kernel)
        w /= sum;
    return kernel;
}

/// Sums for a straight line through (spread excess, HU).
struct Line {
    double count = 0.0, p = 0.0, y = 0.0, pp = 0.0, py = 0.0;

    void add(double excess, double hu) {
        count += 1.0, p += excess, y += hu;
        pp += excess * excess, py += excess * hu;
    }
    void add(const Line& other) {
        count += other.count, p += other.p, y += other.y;
        pp += other.pp, py += other.py;
    }
    // About the means.
    double spread() const { return count > 0.0 ? pp - p * p / count : 0.0; }
    double joint() const { return count > 0.0 ? py - p * y / count : 0.0; }
    double slope() const { return spread() > 0.0 ? joint() / spread() : 0.0; }
};

using LinesBySpread = std::array<Line, widthsMm.size()>;
struct SliceLines {
    LinesBySpread gas, wall;
};

/// A slope with its standard error, by leaving out one part after the other (jackknife). Without
/// two parts that hold any, or with too few in all, the error has no bound.
struct Slope {
    double value = 0.0, error = std::numeric_limits<double>::infinity();
};

Slope slopeOf(const std::vector<Line>& parts) {
    std::vector<double> without;
    Line all;
    for (const Line& part : parts)
        all.add(part);
    for (const Line& part : parts) {
        if (part.count == 0.0) continue;
        Line rest = all;
        rest.add({-part.count, -part.p, -part.y, -part.pp, -part.py});
        without.push_back(rest.slope());
    }
    if (all.count < fewestSamples || without.size() < 2) return {};
    const double count = double(without.size()),
                 mean = std::accumulate(without.begin(), without.end(), 0.0) / count;
    double squares = 0.0;
    for (const double slope : without)
        squares += (slope - mean) * (slope - mean);
    return {all.slope(), std::sqrt((count - 1.0) / count * squares)};
}

/// What the wall has gained at spread `at`. Slabs are counted from the first slice that has wall.
Slope wallSlope(const std::vector<SliceLines>& slices, std::size_t at, double slicesPerSlab) {
    std::vector<Line> slabs;
    const auto hasWall = [&](const SliceLines& slice) { return slice.wall[at].count > 0.0; };
    const auto first = std::ranges::find_if(slices, hasWall);
    for (auto slice = first; slice != slices.end(); ++slice) {
        slabs.resize(std::size_t(double(slice - first) / slicesPerSlab) + 1);
        slabs.back().add(slice->wall[at]);
    }
    return slopeOf(slabs);
}

/// Mean HU of the tagged contents, without what is no denser than soft tissue.
double meanTaggedHu(const CtScan& scan, const Volume<std::uint8_t>& segmentation, double softHu,
                    int threads) {
    const Grid& grid = scan.hu.grid();
    const std::size_t perSlice = std::size_t(grid.size.x) * std::size_t(grid.size.y);
    struct Sum {
        std::int64_t hu = 0, count = 0;
    };
    std::vector<Sum> sums(std::size_t(grid.size.z));
    parallelFor(sums.size(), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin * perSlice; n < end * perSlice; ++n) {
            if (LumenLabel(segmentation[n]) != LumenLabel::tagged || scan.hu[n] <= softHu) continue;
            Sum& sum = sums[n / perSlice];
            sum.hu += scan.hu[n], ++sum.count;
        }
    });
    Sum all;
    for (const Sum& sum : sums)
        all.hu += sum.hu, all.count += sum.count;
    return all.count > 0 ? double(all.hu) / double(all.count) : softHu;
}

}  // namespace

void PseudoEnhancement::takeOff(glm::ivec3 first, std::span<std::int16_t> row) const {
    std::vector<float> excess(row.size());
    excessHu.row(first + begin, excess);
    for (std::size_t i = 0; i < row.size(); ++i) {
        const double added = gain * excess[i];
        if (row[i] > -1024 && added != 0.0)
            row[i] = std::int16_t(std::max(-1024L, std::lround(row[i] - added)));
    }
}

PseudoEnhancement measurePseudoEnhancement(const CtScan& scan, const TissueModel& tissue,
                                           const Volume<std::uint8_t>& segmentation,
                                           const Grid& whole, glm::ivec3 from, int threads) {
    const Grid& grid = scan.hu.grid();
    const double airHu = tissue.meanHu[int(Tissue::air)];
    // The field begins a part of a cell before the whole, so that a cell begins at `from`.
    const glm::ivec3 perCell = excessCell(grid), begin = (perCell - from % perCell) % perCell;
    Grid field = whole;
    field.size += begin;
    from += begin;
    const SmoothField excess = excessOf(scan, segmentation, airHu, field, from, threads);
    std::vector<SmoothField> fields;
    for (const double width : widthsMm) {
        fields.push_back(excess);
        for (int axis = 0; axis < 2; ++axis) {
            const double cell = grid.spacingMm()[axis] * excess.voxelsPerCell()[axis];
            convolveAxis(fields.back().values(), excess.cells(), axis,
                         unitGaussian(width / 2.3548 / cell), threads);
        }
    }
    const Ball ball = blurBall(grid), beyond = widerBall(grid, wallMm);
    // Blocks as wide as `beyond` reaches.
    const NearBlocks near(
        segmentation, glm::ceil((blurReachMm + wallMm + 0.5 * grid.spacingMm()) / grid.spacingMm()),
        [](std::uint8_t label) { return LumenLabel(label) != LumenLabel::outside; });
    const int every = std::max(1, int(std::lround(enhancementSampleMm3 / grid.voxelVolumeMm3())));
    const auto isGas = [&](std::size_t n) {
        return LumenLabel(segmentation[n]) == LumenLabel::air;
    };
    const auto isOutside = [&](std::size_t n) {
        return LumenLabel(segmentation[n]) == LumenLabel::outside;
    };
    const double softHu = tissue.meanHu[int(Tissue::soft)];
    const auto isWall = [&](glm::ivec3 v, std::size_t n) {
        const double hu = scan.hu[n];
        return hu > softHu - belowSoftHu && hu < softHu + aboveSoftHu && near.hold(v) &&
               isOutside(n) && ball.everywhere(v, isOutside) && !beyond.everywhere(v, isOutside);
    };
    std::vector<SliceLines> slices(std::size_t(grid.size.z));
    parallelFor(slices.size(), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                const int first = firstSample(j + 2 * int(k), every);
                for (int i = first; i < grid.size.x; i += every) {
                    const glm::ivec3 v(i, j, int(k));
                    const std::size_t n = grid.index(v);
                    const bool gas = isGas(n) && ball.everywhere(v, isGas);
                    if (!gas && !isWall(v, n)) continue;
                    LinesBySpread& lines = gas ? slices[k].gas : slices[k].wall;
                    for (std::size_t w = 0; w < fields.size(); ++w)
                        lines[w].add(fields[w].at(i + from.x, j + from.y, int(k) + from.z),
                                     scan.hu[n]);
                }
            }
        }
    });
    LinesBySpread lines;
    for (const SliceLines& slice : slices) {
        for (std::size_t w = 0; w < lines.size(); ++w)
            lines[w].add(slice.gas[w]);
    }
    const double sd = measureNoise(scan, tissue, segmentation, threads).soft;
    const double seen = normalCdf((airHu + 1024.0) / sd);
    PseudoEnhancement best;
    double most = 0.0;
    std::size_t at = 0;
    for (std::size_t w = 0; w < lines.size(); ++w) {
        const Line& line = lines[w];
        if (line.count < fewestSamples || line.joint() <= 0.0) continue;
        const double explained = line.joint() * line.slope();  // of the squares
        if (explained <= most) continue;
        most = explained, at = w;
        best.widthMm = widthsMm[w], best.gain = line.slope() / std::max(seen, 0.5);
    }
    const Slope wall = wallSlope(slices, at, std::max(1.0, wallSlabMm / grid.spacingMm().z));
    best.gain = std::min(best.gain, std::max(0.0, wall.value + 2.0 * wall.error));
    const double taggedHu = meanTaggedHu(scan, segmentation, softHu, threads);
    best.gain = std::min(best.gain, mostOfContrast * (taggedHu - softHu) / (taggedHu - airHu));
    if (best.edgeHu() < leastEdgeHu) return {};
    best.excessHu = std::move(fields[at]), best.begin = begin;
    return best;
}

}  // namespace haustra::cleansing
