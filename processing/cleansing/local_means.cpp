#include "cleansing/local_means.h"

#include "cleansing/ball.h"
#include "cleansing/local_tagging.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <cmath>

namespace haustra::cleansing {
namespace {

constexpr double cellMm = 3.0;
constexpr double gasSampleMm3 = 1.8;  // of gas, one voxel of so much is looked at
constexpr double voxelMm3 = 0.6;      // whose weight is 1

/// Sums over each cell.
struct CellSums {
    std::vector<float> weight, value;
    explicit CellSums(std::size_t cells) : weight(cells, 0.0f), value(cells, 0.0f) {}
    void add(std::size_t cell, float w, float hu) { weight[cell] += w, value[cell] += w * hu; }
};

std::vector<float> gaussian(float sigma) {
    const int reach = std::max(1, int(std::ceil(2.5f * sigma)));
    std::vector<float> kernel;
    for (int r = -reach; r <= reach; ++r)
        kernel.push_back(std::exp(-0.5f * float(r * r) / (sigma * sigma)));
    return kernel;
}

/// From the widest neighbourhood to the narrowest, each the prior of the next.
SmoothField normalised(const CellSums& sums, SmoothField field, double prior, double priorVoxels,
                       int threads) {
    std::vector<float>& mean = field.values();
    std::fill(mean.begin(), mean.end(), float(prior));
    for (const float sigma : {8.0f, 4.0f, 2.0f, 1.0f, 0.6f}) {
        const std::vector<float> kernel = gaussian(sigma);
        CellSums wide = sums;
        for (int axis = 0; axis < 3; ++axis) {
            convolveAxis(wide.weight, field.cells(), axis, kernel, threads);
            convolveAxis(wide.value, field.cells(), axis, kernel, threads);
        }
        for (std::size_t c = 0; c < mean.size(); ++c) {
            mean[c] = (wide.value[c] + float(priorVoxels) * mean[c]) /
                      (wide.weight[c] + float(priorVoxels));
        }
    }
    return field;
}

/// What the lumen's contents measure.
struct ContentSums {
    CellSums tagged, air;
    std::vector<char> holdsTagged;         ///< of each cell
    std::vector<double> airSum, airCount;  ///< of each slab of cells

    explicit ContentSums(glm::ivec3 cells)
        : tagged(std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z)),
          air(tagged),
          holdsTagged(tagged.weight.size(), 0),
          airSum(std::size_t(cells.z), 0.0),
          airCount(airSum) {}

    double airHu(double otherwise) const {
        double count = 0.0, sum = 0.0;
        for (std::size_t s = 0; s < airSum.size(); ++s)
            count += airCount[s], sum += airSum[s];
        return count > 100.0 ? sum / count : otherwise;
    }
};

/// Sums of a scan's voxels over cells, of those deeper inside their material than the blur reaches.
class CellSampling {
public:
    CellSampling(const CtScan& scan, const TissueModel& tissue,
                 const Volume<std::uint8_t>& segmentation, const SmoothField& cells, int threads)
        : scan_(scan),
          tissue_(tissue),
          label_(segmentation.voxels()),
          grid_(scan.hu.grid()),
          cells_(cells),
          ball_(blurBall(grid_)),
          look_(neighbourStep(grid_)),
          unit_(float(grid_.voxelVolumeMm3() / voxelMm3)),
          threads_(threads) {}

    ContentSums contents() const {
        const int every = std::max(1, int(std::lround(gasSampleMm3 / grid_.voxelVolumeMm3())));
        const int depth = cells_.voxelsPerCell().z;
        const float airWeight = unit_ * float(every) / 3.0f;
        const auto hu = scan_.hu.voxels();
        const auto isAir = [&](std::size_t n) { return is(n, LumenLabel::air); };
        ContentSums sums(cells_.cells());
        forVoxelsOfCells([&](std::size_t n, glm::ivec3 v) {
            if (is(n, LumenLabel::tagged)) {
                const std::size_t cell = cells_.cellOf(v.x, v.y, v.z);
                sums.holdsTagged[cell] = 1;
                if (hu[n] <= tissue_.meanHu[int(Tissue::soft)]) return;
                sums.tagged.add(cell, unit_ * taggedWeight(n, v), hu[n]);
            } else if (isAir(n) && (v.x + v.y + v.z) % every == 0) {
                if (!ball_.everywhere(v, isAir)) return;
                const std::size_t slab = std::size_t(v.z / depth);
                sums.airSum[slab] += hu[n], sums.airCount[slab] += 1.0;
                sums.air.add(cells_.cellOf(v.x, v.y, v.z), airWeight, hu[n]);
            }
        });
        return sums;
    }

    /// Of soft tissue denser than `leastHu`, in the cells that are `wanted`.
    CellSums softTissue(const std::vector<char>& wanted, double leastHu) const {
        const auto hu = scan_.hu.voxels();
        const auto isSoft = [&](std::size_t n) {
            return label_[n] == 0 && hu[n] > leastHu && hu[n] < tissue_.taggedAboveHu;
        };
        CellSums sums(wanted.size());
        forVoxelsOfCells([&](std::size_t n, glm::ivec3 v) {
            const std::size_t cell = cells_.cellOf(v.x, v.y, v.z);
            if (wanted[cell] && isSoft(n) && ball_.everywhere(v, isSoft))
                sums.add(cell, unit_, hu[n]);
        });
        return sums;
    }

private:
    bool is(std::size_t n, LumenLabel label) const { return LumenLabel(label_[n]) == label; }

    /// 1 for a voxel that the blur of nothing else reaches; a little for the brightest voxels
    /// across a pool that is too thin to have such.
    float taggedWeight(std::size_t n, glm::ivec3 v) const {
        const auto isTagged = [&](std::size_t m) { return is(m, LumenLabel::tagged); };
        if (ball_.everywhere(v, isTagged)) return 1.0f;
        return scan_.hu[n] > tissue_.taggedAboveHu && isCrest(v) ? 0.02f : 0.0f;
    }

    bool isCrest(glm::ivec3 v) const {
        for (int axis = 0; axis < 3; ++axis) {
            for (int side = -1; side <= 1; side += 2) {
                glm::ivec3 beside = v;
                beside[axis] += side * look_[axis];
                if (grid_.contains(beside) && scan_.hu.at(beside) > scan_.hu.at(v)) return false;
            }
        }
        return true;
    }

    /// One slab of cells is one thread's, so that sums do not depend on the threads.
    template <class Visit>
    void forVoxelsOfCells(const Visit& visit) const {
        const std::size_t depth = std::size_t(cells_.voxelsPerCell().z);
        parallelFor(std::size_t(cells_.cells().z), 1, threads_,
                    [&](std::size_t begin, std::size_t end) {
                        visitSlices(grid_, begin * depth,
                                    std::min(end * depth, std::size_t(grid_.size.z)), visit);
                    });
    }

    const CtScan& scan_;
    const TissueModel& tissue_;
    const std::span<const std::uint8_t> label_;
    const Grid grid_;
    const SmoothField& cells_;
    const Ball ball_;
    const glm::ivec3 look_;
    const float unit_;  ///< weight of a voxel
    const int threads_;
};

/// The cells within two of those that are set.
std::vector<char> widened(const std::vector<char>& set, const SmoothField& field) {
    constexpr int reach = 2;
    const glm::ivec3 last = field.cells() - 1;
    std::vector<char> wide(set.size(), 0);
    visitBox(glm::ivec3(0), last, [&](glm::ivec3 c) {
        if (!set[field.cellIndex(c.x, c.y, c.z)]) return;
        const glm::ivec3 lo = glm::max(c - reach, glm::ivec3(0)), hi = glm::min(c + reach, last);
        visitBox(lo, {lo.x, hi.y, hi.z}, [&](glm::ivec3 row) {
            const auto first = wide.begin() + std::ptrdiff_t(field.cellIndex(row.x, row.y, row.z));
            std::fill(first, first + (hi.x - lo.x + 1), char(1));
        });
    });
    return wide;
}

}  // namespace

glm::ivec3 cellVoxels(const Grid& grid) {
    return voxelsIn(grid, cellMm);
}

LocalMeans measureLocalMeans(const CtScan& scan, const TissueModel& tissue,
                             const Volume<std::uint8_t>& segmentation,
                             const TaggedSurroundings& around, int threads) {
    const Grid& grid = scan.hu.grid();
    const SmoothField cells(grid, cellVoxels(grid));
    const double softHu = tissue.meanHu[int(Tissue::soft)];
    const double fatHu = tissue.meanHu[int(Tissue::fat)];
    LocalMeans means;
    means.noise = measureNoise(scan, tissue, segmentation, threads);
    const CellSampling sampling(scan, tissue, segmentation, cells, threads);
    const ContentSums contents = sampling.contents();
    means.airHu = normalised(contents.air, cells, contents.airHu(tissue.meanHu[int(Tissue::air)]),
                             1.0, threads);
    // Soft tissue within two cells of the tagging.
    const double leastHu = std::max(0.5 * (softHu + fatHu), softHu - 3.0 * means.noise.soft);
    const CellSums soft = sampling.softTissue(widened(contents.holdsTagged, cells), leastHu);
    const SmoothField taggedHu =
        normalised(contents.tagged, cells,
                   std::max(tissue.meanHu[int(Tissue::taggedOrBone)], tissue.taggedAboveHu + 20.0),
                   0.05, threads);
    means.softHu = normalised(soft, cells, softHu, 8.0, threads);
    means.taggedHu =
        refineTagging(scan, segmentation, around, taggedHu, means, tissue.taggedAboveHu, threads);
    return means;
}

}  // namespace haustra::cleansing
