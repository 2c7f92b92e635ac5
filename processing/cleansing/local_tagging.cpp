#include "cleansing/local_tagging.h"

#include "cleansing/ball.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haustra::cleansing {
namespace {

constexpr double evenMm = 1.5;  // along the rows and columns, over which even contents are averaged
constexpr double coarseWeight = 0.02;  // of one voxel 4 mm away

/// refineTagging's steps, each for one voxel.
class TaggingSteps {
public:
    TaggingSteps(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                 const SmoothField& coarse, const LocalMeans& means, double denseAboveHu)
        : grid_(scan.hu.grid()),
          hu_(scan.hu.voxels()),
          label_(segmentation.voxels()),
          coarse_(coarse),
          means_(means),
          denseAboveHu_(denseAboveHu),
          noiseSd_(means.noise.tagged),
          ball_(blurBall(grid_)),
          look_(neighbourStep(grid_)),
          averaged_(voxelsIn(grid_, evenMm)),
          window_(blurReachVoxels(grid_)) {}

    /// Whether contents are even at a voxel (refineTagging).
    bool isEven(std::size_t n) const {
        const glm::ivec3 v = grid_.voxelAt(n);
        const double soft = softHu(v), mean = crossMean(v);
        const double tolerance = std::max(4.0 * noiseSd_, 0.12 * (coarseHu(v) - soft));
        return mean > soft + 2.0 * noiseSd_ && ball_.everywhere(v, [&](std::size_t m) {
            return isDense(m) && std::abs(hu_[m] - mean) < tolerance;
        });
    }

    std::int16_t evenMean(std::size_t n, std::span<const std::uint8_t> even) const {
        double sum = 0.0;
        int count = 0;
        eachStep(grid_, grid_.voxelAt(n), averaged_, look_, [&](glm::ivec3 at) {
            const std::size_t m = grid_.index(at);
            if (even[m]) sum += hu_[m], ++count;
        });
        return std::int16_t(std::lround(sum / count));
    }

    /// The tagging's HU where contents are not even, by `evenHu` of the even voxels whose blur
    /// reaches this one.
    std::int16_t between(std::size_t n, std::span<const std::uint8_t> even,
                         std::span<const std::int16_t> evenHu) const {
        const glm::ivec3 v = grid_.voxelAt(n);
        const glm::dvec3 spacing = grid_.spacingMm();
        double weight = coarseWeight, sum = coarseWeight * coarseHu(v);
        double least = std::numeric_limits<double>::max(), most = -least;
        eachStep(grid_, v, window_, look_, [&](glm::ivec3 at) {
            const std::size_t m = grid_.index(at);
            if (!even[m]) return;
            const glm::dvec3 d = glm::dvec3(at - v) * spacing;
            const double d2 = glm::dot(d, d), w = 1.0 / (d2 * d2 + 0.1);
            const double there = evenHu[m];
            weight += w, sum += w * there;
            least = std::min(least, there), most = std::max(most, there);
        });
        double value = sum / weight;
        // Between two unlike contents it is what the scan shows.
        if (isDense(n) && most - least > std::max(6.0 * noiseSd_, 0.1 * (value - least))) {
            const double here = crossMean(v);
            if (here > least - noiseSd_ && here < most + noiseSd_) value = here;
        }
        return std::int16_t(std::clamp(std::lround(value), 1L, 3071L));
    }

private:
    double softHu(glm::ivec3 v) const { return means_.softHu.at(v.x, v.y, v.z); }
    double coarseHu(glm::ivec3 v) const { return coarse_.at(v.x, v.y, v.z); }

    /// Stool that the segmentation missed at a pool's border is tagged too; what is less than half
    /// as dense as the pool may be another bowel behind the wall.
    bool isDense(std::size_t n) const {
        if (LumenLabel(label_[n]) == LumenLabel::tagged) return true;
        if (hu_[n] <= denseAboveHu_) return false;
        const glm::ivec3 v = grid_.voxelAt(n);
        const double soft = softHu(v);
        return hu_[n] > soft + 0.5 * (coarseHu(v) - soft);
    }

    /// Mean of a voxel and those one step to either side along the axes that are dense.
    double crossMean(glm::ivec3 v) const {
        double sum = hu_[grid_.index(v)];
        int count = 1;
        for (int axis = 0; axis < 3; ++axis) {
            for (int side = -1; side <= 1; side += 2) {
                glm::ivec3 n = v;
                n[axis] += side * look_[axis];
                if (!grid_.contains(n) || !isDense(grid_.index(n))) continue;
                sum += hu_[grid_.index(n)], ++count;
            }
        }
        return sum / count;
    }

    const Grid grid_;
    const std::span<const std::int16_t> hu_;
    const std::span<const std::uint8_t> label_;
    const SmoothField& coarse_;
    const LocalMeans& means_;
    const double denseAboveHu_, noiseSd_;
    const Ball ball_;
    const glm::ivec3 look_, averaged_, window_;
};

}  // namespace

Volume<std::int16_t> refineTagging(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                                   const TaggedSurroundings& around, const SmoothField& coarse,
                                   const LocalMeans& means, double denseAboveHu, int threads) {
    const Grid& grid = scan.hu.grid();
    const TaggingSteps steps(scan, segmentation, coarse, means, denseAboveHu);
    Volume<std::uint8_t> evenVoxels(grid, std::uint8_t(0));
    const auto even = evenVoxels.writable();
    forEachVoxel(around, 1 << 13, threads, [&](std::size_t n) { even[n] = steps.isEven(n); });
    Volume<std::int16_t> tagging(grid, std::int16_t(0));
    const auto out = tagging.writable();
    forEachVoxel(around, 1 << 13, threads, [&](std::size_t n) {
        if (even[n]) out[n] = steps.evenMean(n, even);
    });
    forEachVoxel(around, 1 << 12, threads, [&](std::size_t n) {
        if (!even[n]) out[n] = steps.between(n, even, out);
    });
    return tagging;
}

}  // namespace haustra::cleansing
