#include "cleansing/local_means.h"

#include "cleansing/ball.h"
#include "cleansing/local_tagging.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace haustra::cleansing {
namespace {

constexpr double cellMm = 3.0;
constexpr double sampleMm3 = 1.8;  // of gas, one voxel of so much is looked at
constexpr double voxelMm3 = 0.6;   // whose weight is 1

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
      perVoxel_(1.0f / glm::vec3(voxelsPerCell)),
      values_(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z), 0.0f) {}

float SmoothField::at(int i, int j, int k) const {
    const glm::vec3 p = glm::clamp((glm::vec3(i, j, k) + 0.5f) * perVoxel_ - 0.5f, glm::vec3(0.0f),
                                   glm::vec3(cells_ - 1));
    const glm::ivec3 lo = glm::min(glm::ivec3(p), glm::max(cells_ - 2, glm::ivec3(0)));
    const glm::ivec3 hi = glm::min(lo + 1, cells_ - 1);
    const glm::vec3 f = p - glm::vec3(lo);
    auto x = [&](int b, int c) {
        const float a = values_[cellIndex(lo.x, b, c)];
        return a + f.x * (values_[cellIndex(hi.x, b, c)] - a);
    };
    auto y = [&](int c) {
        const float a = x(lo.y, c);
        return a + f.y * (x(hi.y, c) - a);
    };
    const float a = y(lo.z);
    return a + f.z * (y(hi.z) - a);
}

void SmoothField::row(int j, int k, std::span<float> values) const {
    const glm::vec2 p =
        glm::clamp((glm::vec2(j, k) + 0.5f) * glm::vec2(perVoxel_.y, perVoxel_.z) - 0.5f,
                   glm::vec2(0.0f), glm::vec2(cells_.y - 1, cells_.z - 1));
    const glm::ivec2 lo = glm::min(glm::ivec2(p), glm::max(glm::ivec2(cells_.y, cells_.z) - 2, 0));
    const glm::ivec2 hi = glm::min(lo + 1, glm::ivec2(cells_.y, cells_.z) - 1);
    const glm::vec2 f = p - glm::vec2(lo);
    std::vector<float> across(std::size_t(cells_.x));
    for (int x = 0; x < cells_.x; ++x) {
        const auto mixed = [&](int z) {
            return glm::mix(values_[cellIndex(x, lo.x, z)], values_[cellIndex(x, hi.x, z)], f.x);
        };
        across[std::size_t(x)] = glm::mix(mixed(lo.y), mixed(hi.y), f.y);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float at =
            std::clamp((float(i) + 0.5f) * perVoxel_.x - 0.5f, 0.0f, float(cells_.x - 1));
        const int left = std::min(int(at), std::max(cells_.x - 2, 0)),
                  right = std::min(left + 1, cells_.x - 1);
        values[i] =
            glm::mix(across[std::size_t(left)], across[std::size_t(right)], at - float(left));
    }
}

LocalMeans measureLocalMeans(const CtScan& scan, const TissueModel& tissue,
                             const Volume<std::uint8_t>& segmentation,
                             const TaggedSurroundings& around, int threads) {
    const Grid& grid = scan.hu.grid();
    const glm::ivec3 perCell =
        glm::max(glm::ivec3(glm::round(cellMm / grid.spacingMm())), glm::ivec3(1));
    LocalMeans means;
    SmoothField taggedHu(grid, perCell);
    means.softHu = SmoothField(grid, perCell);
    const glm::ivec3 cells = taggedHu.cells();
    const auto hu = scan.hu.voxels();
    const auto label = segmentation.voxels();
    const std::vector<glm::ivec3> ball = blurBall(grid);
    const glm::ivec3 look = lookStep(grid);
    const auto isTagged = [&](std::size_t n) { return LumenLabel(label[n]) == LumenLabel::tagged; };
    const auto isAir = [&](std::size_t n) { return LumenLabel(label[n]) == LumenLabel::air; };

    means.noise = measureNoise(scan, tissue, segmentation, threads);
    const float unit = float(grid.voxelVolumeMm3() / voxelMm3);
    const int every = std::max(1, int(std::lround(sampleMm3 / grid.voxelVolumeMm3())));

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
                        if (everywhere(grid, ball, {i, j, k}, isTagged)) {
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
                    } else if (isAir(n) && (i + j + k) % every == 0) {
                        if (!everywhere(grid, ball, {i, j, k}, isAir)) continue;
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
                    if (!isSoft(n) || !everywhere(grid, ball, {i, j, k}, isSoft)) continue;
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
