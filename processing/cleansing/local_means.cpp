#include "cleansing/local_means.h"

#include "cleansing/ball.h"
#include "cleansing/local_tagging.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace haustra::cleansing {
namespace {

constexpr double cellMm = 3.0;
constexpr double gasSampleMm3 = 1.8;  // of gas, one voxel of so much is looked at
constexpr double voxelMm3 = 0.6;      // whose weight is 1

// Sums over one cell.
struct CellSums {
    std::vector<float> weight, value;
    explicit CellSums(std::size_t cells) : weight(cells, 0.0f), value(cells, 0.0f) {}
};

void blurAxis(std::vector<float>& data, glm::ivec3 size, int axis, float sigma, int threads) {
    const int reach = std::max(1, int(std::ceil(2.5f * sigma)));
    std::vector<float> kernel(std::size_t(reach) + 1);
    for (int r = 0; r <= reach; ++r)
        kernel[std::size_t(r)] = std::exp(-0.5f * float(r * r) / (sigma * sigma));
    const std::size_t stride = axis == 0   ? 1
                               : axis == 1 ? std::size_t(size.x)
                                           : std::size_t(size.x) * std::size_t(size.y);
    const int length = size[axis];
    const std::size_t count = data.size() / std::size_t(length);
    parallelFor(count, 256, threads, [&](std::size_t first, std::size_t last) {
        std::vector<float> line(static_cast<std::size_t>(length));
        for (std::size_t l = first; l < last; ++l) {
            const std::size_t begin = l % stride + l / stride * stride * std::size_t(length);
            bool any = false;
            for (int n = 0; n < length; ++n) {
                line[std::size_t(n)] = data[begin + std::size_t(n) * stride];
                any |= line[std::size_t(n)] != 0.0f;
            }
            if (!any) continue;
            for (int n = 0; n < length; ++n) {
                float sum = 0.0f;
                for (int m = std::max(0, n - reach); m <= std::min(length - 1, n + reach); ++m)
                    sum += kernel[std::size_t(std::abs(m - n))] * line[std::size_t(m)];
                data[begin + std::size_t(n) * stride] = sum;
            }
        }
    });
}

// From the widest neighbourhood to the narrowest, each the prior of the next.
void fill(SmoothField& field, const CellSums& sums, double prior, double priorVoxels, int threads) {
    std::vector<float>& mean = field.values();
    std::fill(mean.begin(), mean.end(), float(prior));
    for (const float sigma : {8.0f, 4.0f, 2.0f, 1.0f, 0.6f}) {
        CellSums wide = sums;
        for (int axis = 0; axis < 3; ++axis) {
            blurAxis(wide.weight, field.cells(), axis, sigma, threads);
            blurAxis(wide.value, field.cells(), axis, sigma, threads);
        }
        for (std::size_t c = 0; c < mean.size(); ++c) {
            mean[c] = (wide.value[c] + float(priorVoxels) * mean[c]) /
                      (wide.weight[c] + float(priorVoxels));
        }
    }
}

}  // namespace

SmoothField::SmoothField(const Grid& grid, glm::ivec3 voxelsPerCell)
    : perCell_(voxelsPerCell),
      cells_((grid.size + voxelsPerCell - 1) / voxelsPerCell),
      values_(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z), 0.0f) {
    for (int axis = 0; axis < 3; ++axis) {
        const int per = perCell_[axis], last = cells_[axis] - 1;
        for (int n = 0; n < grid.size[axis]; ++n) {
            // Of the voxel's place in its cell alone: wherever a grid begins, the same.
            const float past = (float(n % per) + 0.5f) / float(per) - 0.5f;
            const int cell = past < 0.0f ? n / per - 1 : n / per;
            const float share = past < 0.0f ? past + 1.0f : past;
            between_[std::size_t(axis)].push_back(
                {std::max(cell, 0), std::min(cell + 1, last), cell < 0 ? 0.0f : share});
        }
    }
}

float SmoothField::at(int i, int j, int k) const {
    const Between &x = between_[0][std::size_t(i)], &y = between_[1][std::size_t(j)],
                  &z = between_[2][std::size_t(k)];
    const auto along = [&](int b, int c) {
        const float* row = &values_[cellIndex(0, b, c)];
        return row[x.lo] + x.share * (row[x.hi] - row[x.lo]);
    };
    const auto across = [&](int c) {
        const float a = along(y.lo, c);
        return a + y.share * (along(y.hi, c) - a);
    };
    const float a = across(z.lo);
    return z.share == 0.0f ? a : a + z.share * (across(z.hi) - a);
}

void SmoothField::row(glm::ivec3 first, std::span<float> values) const {
    const Between &y = between_[1][std::size_t(first.y)], &z = between_[2][std::size_t(first.z)];
    std::vector<float> across(std::size_t(cells_.x));
    for (int x = 0; x < cells_.x; ++x) {
        const auto mixed = [&](int c) {
            return glm::mix(values_[cellIndex(x, y.lo, c)], values_[cellIndex(x, y.hi, c)],
                            y.share);
        };
        across[std::size_t(x)] = glm::mix(mixed(z.lo), mixed(z.hi), z.share);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Between& x = between_[0][std::size_t(first.x) + i];
        values[i] = glm::mix(across[std::size_t(x.lo)], across[std::size_t(x.hi)], x.share);
    }
}

glm::ivec3 cellVoxels(const Grid& grid) {
    return voxelsIn(grid, cellMm);
}

LocalMeans measureLocalMeans(const CtScan& scan, const TissueModel& tissue,
                             const Volume<std::uint8_t>& segmentation,
                             const TaggedSurroundings& around, int threads, glm::ivec3 from) {
    const Grid& grid = scan.hu.grid();
    const glm::ivec3 perCell = cellVoxels(grid);
    LocalMeans means;
    SmoothField taggedHu(grid, perCell);
    means.softHu = SmoothField(grid, perCell);
    const glm::ivec3 cells = taggedHu.cells();
    const auto hu = scan.hu.voxels();
    const auto label = segmentation.voxels();
    const Ball ball = blurBall(grid);
    const glm::ivec3 look = lookStep(grid);
    const auto isTagged = [&](std::size_t n) { return LumenLabel(label[n]) == LumenLabel::tagged; };
    const auto isAir = [&](std::size_t n) { return LumenLabel(label[n]) == LumenLabel::air; };

    means.noise = measureNoise(scan, tissue, segmentation, threads, from);
    const float unit = float(grid.voxelVolumeMm3() / voxelMm3);
    const int every = std::max(1, int(std::lround(gasSampleMm3 / grid.voxelVolumeMm3())));
    const int sampled = from.x + from.y + from.z;

    // One slab of cells is one thread's, so sums do not depend on the threads.
    CellSums air(taggedHu.values().size()), tagged(taggedHu.values().size()),
        soft(means.softHu.values().size());
    std::vector<double> airSum(std::size_t(cells.z), 0.0), airCount(airSum);
    std::vector<char> holdsTagged(tagged.weight.size(), 0);
    parallelFor(std::size_t(cells.z), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (int k = int(begin) * perCell.z; k < std::min(int(end) * perCell.z, grid.size.z); ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                const std::size_t row = grid.index(0, j, k);
                for (int i = 0; i < grid.size.x; ++i) {
                    const std::size_t n = row + std::size_t(i);
                    if (isTagged(n)) {
                        const std::size_t cell = taggedHu.cellOf(i, j, k);
                        holdsTagged[cell] = 1;
                        if (hu[n] <= tissue.meanHu[int(Tissue::soft)]) continue;
                        // Where the pool is too thin to have an inside, its crest is the best.
                        float weight = 0.0f;
                        if (ball.everywhere({i, j, k}, isTagged)) {
                            weight = 1.0f;
                        } else {
                            bool crest = hu[n] > tissue.taggedAboveHu;
                            for (int axis = 0; crest && axis < 3; ++axis) {
                                for (int side = -1; side <= 1; side += 2) {
                                    glm::ivec3 v(i, j, k);
                                    v[axis] += side * look[axis];
                                    if (grid.contains(v) && scan.hu.at(v) > hu[n]) crest = false;
                                }
                            }
                            if (crest) weight = 0.02f;
                        }
                        weight *= unit;
                        tagged.weight[cell] += weight, tagged.value[cell] += weight * hu[n];
                    } else if (isAir(n) && (i + j + k + sampled) % every == 0) {
                        if (!ball.everywhere({i, j, k}, isAir)) continue;
                        const std::size_t slab = std::size_t(k / perCell.z);
                        airSum[slab] += hu[n], airCount[slab] += 1.0;
                        const std::size_t cell = taggedHu.cellOf(i, j, k);
                        const float weight = unit * float(every) / 3.0f;
                        air.weight[cell] += weight, air.value[cell] += weight * hu[n];
                    }
                }
            }
        }
    });
    double count = 0.0, sum = 0.0;
    for (std::size_t s = 0; s < airSum.size(); ++s)
        count += airCount[s], sum += airSum[s];
    means.airHu = SmoothField(grid, perCell);
    fill(means.airHu, air, count > 100.0 ? sum / count : tissue.meanHu[int(Tissue::air)], 1.0,
         threads);

    // Soft tissue within two cells of the tagging.
    const double softHu = tissue.meanHu[int(Tissue::soft)];
    const double fatHu = tissue.meanHu[int(Tissue::fat)];
    const double leastHu = std::max(0.5 * (softHu + fatHu), softHu - 3.0 * means.noise.soft);
    const auto isSoft = [&](std::size_t n) {
        return label[n] == 0 && hu[n] > leastHu && hu[n] < tissue.taggedAboveHu;
    };
    std::vector<char> wanted(holdsTagged.size(), 0);
    for (int k = 0; k < cells.z; ++k) {
        for (int j = 0; j < cells.y; ++j) {
            for (int i = 0; i < cells.x; ++i) {
                if (!holdsTagged[means.softHu.cellIndex(i, j, k)]) continue;
                const glm::ivec3 lo = glm::max(glm::ivec3(i, j, k) - 2, glm::ivec3(0)),
                                 hi = glm::min(glm::ivec3(i, j, k) + 2, cells - 1);
                for (int c = lo.z; c <= hi.z; ++c) {
                    for (int b = lo.y; b <= hi.y; ++b) {
                        std::fill(&wanted[means.softHu.cellIndex(lo.x, b, c)],
                                  &wanted[means.softHu.cellIndex(hi.x, b, c)] + 1, 1);
                    }
                }
            }
        }
    }
    parallelFor(std::size_t(cells.z), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (int k = int(begin) * perCell.z; k < std::min(int(end) * perCell.z, grid.size.z); ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                for (int i = 0; i < grid.size.x; ++i) {
                    const std::size_t cell = means.softHu.cellOf(i, j, k);
                    if (!wanted[cell]) continue;
                    const std::size_t n = grid.index(i, j, k);
                    if (!isSoft(n) || !ball.everywhere({i, j, k}, isSoft)) continue;
                    soft.weight[cell] += unit, soft.value[cell] += unit * hu[n];
                }
            }
        }
    });
    fill(taggedHu, tagged,
         std::max(tissue.meanHu[int(Tissue::taggedOrBone)], tissue.taggedAboveHu + 20.0), 0.05,
         threads);
    fill(means.softHu, soft, softHu, 8.0, threads);
    means.taggedHu =
        refineTagging(scan, segmentation, around, taggedHu, means, tissue.taggedAboveHu, threads);
    return means;
}

}  // namespace haustra::cleansing
