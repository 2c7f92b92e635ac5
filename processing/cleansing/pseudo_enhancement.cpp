#include "cleansing/pseudo_enhancement.h"

#include "cleansing/ball.h"
#include "cleansing/noise.h"
#include "cleansing/normal_distribution.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace haustra::cleansing {
namespace {

constexpr std::array<double, 5> widthsMm = {8.0, 12.0, 16.0, 24.0, 32.0};
constexpr double excessCellMm = 3.0;          // in the slice
constexpr double enhancementSampleMm3 = 4.0;  // one voxel of so much is looked at
constexpr double leastEdgeHu = 4.0;
constexpr double fewestSamples = 500.0;

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
    const Ball ball = blurBall(grid);
    const int every = std::max(1, int(std::lround(enhancementSampleMm3 / grid.voxelVolumeMm3())));
    const auto isGas = [&](std::size_t n) {
        return LumenLabel(segmentation[n]) == LumenLabel::air;
    };
    using Lines = std::array<Line, widthsMm.size()>;  // by spread
    std::vector<Lines> slices(std::size_t(grid.size.z));
    parallelFor(slices.size(), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                const int first = firstSample(j + 2 * int(k), every);
                for (int i = first; i < grid.size.x; i += every) {
                    const glm::ivec3 v(i, j, int(k));
                    const std::size_t n = grid.index(v);
                    if (!isGas(n) || !ball.everywhere(v, isGas)) continue;
                    for (std::size_t w = 0; w < fields.size(); ++w)
                        slices[k][w].add(fields[w].at(i + from.x, j + from.y, int(k) + from.z),
                                         scan.hu[n]);
                }
            }
        }
    });
    Lines lines;
    for (const Lines& slice : slices) {
        for (std::size_t w = 0; w < lines.size(); ++w)
            lines[w].add(slice[w]);
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
    if (best.edgeHu() < leastEdgeHu) return {};
    best.excessHu = std::move(fields[at]), best.begin = begin;
    return best;
}

}  // namespace haustra::cleansing
