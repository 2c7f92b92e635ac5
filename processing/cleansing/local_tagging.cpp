#include "cleansing/local_tagging.h"

#include "cleansing/ball.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haustra::cleansing {
namespace {

constexpr double evenMm = 1.5;  // along the rows and columns, over which even contents are averaged

/// Mean of a voxel and those a look to either side along the axes that are dense.
template <class Predicate>
double crossMean(const Volume<std::int16_t>& hu, const Predicate& isDense, glm::ivec3 v) {
    const glm::ivec3 look = lookStep(hu.grid());
    double sum = hu.at(v);
    int count = 1;
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = -1; side <= 1; side += 2) {
            glm::ivec3 n = v;
            n[axis] += side * look[axis];
            if (!hu.grid().contains(n) || !isDense(hu.grid().index(n))) continue;
            sum += hu.at(n), ++count;
        }
    }
    return sum / count;
}

}  // namespace

Volume<std::int16_t> refineTagging(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                                   const TaggedSurroundings& around, const SmoothField& coarse,
                                   const LocalMeans& means, double denseAboveHu, int threads) {
    const Grid& grid = scan.hu.grid();
    const auto hu = scan.hu.voxels();
    const auto label = segmentation.voxels();
    const Ball ball = blurBall(grid);

    const double noiseSd = means.noise.tagged;
    const glm::ivec3 look = lookStep(grid);

    // Stool that the segmentation missed at a pool's border is tagged too; what is less than half
    // as dense as the pool may be another bowel behind the wall.
    const auto isDense = [&](std::size_t n) {
        if (LumenLabel(label[n]) == LumenLabel::tagged) return true;
        if (hu[n] <= denseAboveHu) return false;
        const glm::ivec3 v = grid.voxelAt(n);
        const double soft = means.softHu.at(v.x, v.y, v.z);
        return hu[n] > soft + 0.5 * (coarse.at(v.x, v.y, v.z) - soft);
    };

    // Even contents: the blur of nothing else reaches in.
    Volume<std::uint8_t> evenVoxels(grid, std::uint8_t(0));
    const auto even = evenVoxels.writable();
    for (const auto& shell : around.shells) {
        parallelFor(shell.size(), 1 << 13, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                const glm::ivec3 v = grid.voxelAt(shell[m]);
                const double soft = means.softHu.at(v.x, v.y, v.z);
                const double mean = crossMean(scan.hu, isDense, v);
                const double tolerance =
                    std::max(4.0 * noiseSd, 0.12 * (coarse.at(v.x, v.y, v.z) - soft));
                even[shell[m]] =
                    mean > soft + 2.0 * noiseSd && ball.everywhere(v, [&](std::size_t n) {
                        return isDense(n) && std::abs(hu[n] - mean) < tolerance;
                    });
            }
        });
    }

    const glm::ivec3 averaged = voxelsIn(grid, evenMm);
    Volume<std::int16_t> tagging(grid, std::int16_t(0));
    const auto out = tagging.writable();
    for (const auto& shell : around.shells) {
        parallelFor(shell.size(), 1 << 13, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                if (!even[shell[m]]) continue;
                const glm::ivec3 v = grid.voxelAt(shell[m]);
                double sum = 0.0;
                int count = 0;
                eachStep(grid, v, averaged, look, [&](glm::ivec3 at) {
                    const std::size_t n = grid.index(at);
                    if (even[n]) sum += hu[n], ++count;
                });
                out[shell[m]] = std::int16_t(std::lround(sum / count));
            }
        });
    }

    constexpr double coarseWeight = 0.02;  // of one voxel 4 mm away
    const glm::dvec3 spacing = grid.spacingMm();
    const glm::ivec3 window = blurReachVoxels(grid);
    for (const auto& shell : around.shells) {
        parallelFor(shell.size(), 1 << 12, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                if (even[shell[m]]) continue;
                const glm::ivec3 v = grid.voxelAt(shell[m]);
                double weight = coarseWeight, sum = coarseWeight * coarse.at(v.x, v.y, v.z);
                double least = std::numeric_limits<double>::max(), most = -least;
                eachStep(grid, v, window, look, [&](glm::ivec3 at) {
                    const std::size_t n = grid.index(at);
                    if (!even[n]) return;
                    const glm::dvec3 d = glm::dvec3(at - v) * spacing;
                    const double d2 = glm::dot(d, d), w = 1.0 / (d2 * d2 + 0.1);
                    const double there = out[n];
                    weight += w, sum += w * there;
                    least = std::min(least, there), most = std::max(most, there);
                });
                double value = sum / weight;
                if (isDense(shell[m]) &&
                    most - least > std::max(6.0 * noiseSd, 0.1 * (value - least))) {
                    const double here = crossMean(scan.hu, isDense, v);
                    if (here > least - noiseSd && here < most + noiseSd) value = here;
                }
                out[shell[m]] = std::int16_t(std::clamp(std::lround(value), 1L, 3071L));
            }
        });
    }
    return tagging;
}

}  // namespace haustra::cleansing
