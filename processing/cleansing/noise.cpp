#include "cleansing/noise.h"

#include "cleansing/ball.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <vector>

namespace haustra::cleansing {
namespace {

constexpr double apartMm = 2.4;
constexpr double apartFromTaggingMm = 6.0;  // soft tissue farther off is another place
constexpr double sampleMm3 = 1.0;           // one voxel of so much is looked at at most,
constexpr std::size_t samples = 200'000;    // and about so many: 0.2 % of the deviation
constexpr std::uint64_t fewest = 100;
constexpr int farthest = 4096;

using Counts = std::array<std::uint32_t, farthest>;  // by |a − 2b + c|

/// Root mean square of the differences within four times itself, over √6.
double standardDeviation(const Counts& counts) {
    double sd = 1e9;
    for (int pass = 0; pass < 20; ++pass) {
        double total = 0.0, square = 0.0;
        for (int d = 0; d < farthest && d < 4.0 * sd; ++d)
            total += counts[std::size_t(d)], square += double(counts[std::size_t(d)]) * d * d;
        if (total < 0.5 * fewest) return 0.0;
        const double next = std::sqrt(square / total);
        if (std::abs(next - sd) < 1e-3) break;
        sd = std::max(next, 1.0);
    }
    return sd / std::sqrt(6.0);
}

/// Blocks of 6 mm that hold tagging, and those beside them.
std::vector<char> blocksNearTagging(const Volume<std::uint8_t>& segmentation, glm::ivec3 block,
                                    glm::ivec3 blocks, glm::ivec3 from) {
    const Grid& grid = segmentation.grid();
    std::vector<char> near(std::size_t(blocks.x) * std::size_t(blocks.y) * std::size_t(blocks.z));
    for (int k = 0; k < grid.size.z; ++k) {
        for (int j = 0; j < grid.size.y; ++j) {
            for (int i = 0; i < grid.size.x; ++i) {
                if (LumenLabel(segmentation.at(i, j, k)) != LumenLabel::tagged) continue;
                const glm::ivec3 b = (glm::ivec3(i, j, k) + from) / block - from / block;
                const glm::ivec3 lo = glm::max(b - 1, glm::ivec3(0)),
                                 hi = glm::min(b + 1, blocks - 1);
                for (int c = lo.z; c <= hi.z; ++c) {
                    for (int a = lo.y; a <= hi.y; ++a) {
                        const auto row =
                            near.begin() + (std::ptrdiff_t(c) * blocks.y + a) * blocks.x;
                        std::fill(row + lo.x, row + hi.x + 1, 1);
                    }
                }
                // The rest of the block adds nothing.
                i = (b.x + from.x / block.x + 1) * block.x - 1 - from.x;
            }
        }
    }
    return near;
}

}  // namespace

NoiseSd measureNoise(const CtScan& scan, const TissueModel& tissue,
                     const Volume<std::uint8_t>& segmentation, int threads, glm::ivec3 from) {
    const Grid& grid = scan.hu.grid();
    const Ball ball = blurBall(grid);
    const glm::ivec3 apart(glm::ceil(apartMm / grid.spacingMm()));
    const auto everyOf = [&](std::size_t voxels) {
        return std::max(
            {1, int(std::lround(sampleMm3 / grid.voxelVolumeMm3())), int(voxels / samples)});
    };
    // Blocks, and the voxels looked at, are those of the whole scan.
    const glm::ivec3 block = voxelsIn(grid, apartFromTaggingMm),
                     blocks = (from + grid.size + block - 1) / block - from / block;
    const std::vector<char> near = blocksNearTagging(segmentation, block, blocks, from);

    /// Differences about the voxels of which `is` holds, each deep inside.
    const auto differences = [&](const auto& wanted, const auto& is, int every) {
        Counts counts{};
        std::mutex mutex;
        parallelFor(std::size_t(grid.size.z), 4, threads, [&](std::size_t begin, std::size_t end) {
            Counts some{};
            for (int k = int(begin); k < int(end); ++k) {
                for (int j = 0; j < grid.size.y; ++j) {
                    for (int i = firstSample(j + from.y + 2 * (k + from.z), from.x, every);
                         i < grid.size.x; i += every) {
                        const glm::ivec3 v(i, j, k);
                        const auto deep = [&](glm::ivec3 n) {
                            return is(grid.index(n)) && ball.everywhere(n, is);
                        };
                        if (!wanted(v) || !is(grid.index(v)) || !deep(v)) continue;
                        for (int axis = 0; axis < 2; ++axis) {
                            glm::ivec3 step(0);
                            step[axis] = apart[axis];
                            if (!grid.contains(v - step) || !grid.contains(v + step) ||
                                !deep(v - step) || !deep(v + step))
                                continue;
                            const int d = std::abs(scan.hu.at(v - step) - 2 * scan.hu.at(v) +
                                                   scan.hu.at(v + step));
                            if (d < farthest) ++some[std::size_t(d)];
                        }
                    }
                }
            }
            const std::lock_guard lock(mutex);  // sums of integers: the order does not matter
            for (std::size_t d = 0; d < counts.size(); ++d)
                counts[d] += some[d];
        });
        std::uint64_t total = 0;
        for (const std::uint32_t count : counts)
            total += count;
        return total < fewest ? 0.0 : standardDeviation(counts);
    };
    const auto anywhere = [](glm::ivec3) { return true; };
    const auto labelled = [&](LumenLabel label) {
        return [&, label](std::size_t n) { return LumenLabel(segmentation[n]) == label; };
    };
    NoiseSd sd;
    const auto voxelsOf = [&](LumenLabel label) {
        return std::size_t(std::count(segmentation.voxels().begin(), segmentation.voxels().end(),
                                      std::uint8_t(label)));
    };
    sd.gas = differences(anywhere, labelled(LumenLabel::air), everyOf(voxelsOf(LumenLabel::air)));
    sd.tagged =
        differences(anywhere, labelled(LumenLabel::tagged), everyOf(voxelsOf(LumenLabel::tagged)));
    // Wide enough that the window cuts off none of the noise.
    const double softHu = tissue.meanHu[int(Tissue::soft)],
                 window = std::max(70.0, 4.5 * std::max(sd.gas, sd.tagged));
    sd.soft = differences(
        [&](glm::ivec3 v) {
            const glm::ivec3 b = (v + from) / block - from / block;
            return near[(std::size_t(b.z) * std::size_t(blocks.y) + std::size_t(b.y)) *
                            std::size_t(blocks.x) +
                        std::size_t(b.x)] != 0;
        },
        [&](std::size_t n) {
            return segmentation[n] == 0 && std::abs(scan.hu[n] - softHu) < window;
        },
        everyOf(std::size_t(std::count(near.begin(), near.end(), 1)) * std::size_t(block.x) *
                std::size_t(block.y) * std::size_t(block.z) / 4));
    const double any = sd.gas > 0.0      ? sd.gas
                       : sd.tagged > 0.0 ? sd.tagged
                       : sd.soft > 0.0   ? sd.soft
                                         : tissue.sdHu[int(Tissue::soft)];
    if (sd.soft == 0.0) sd.soft = std::max(any, sd.tagged);
    if (sd.tagged == 0.0) sd.tagged = std::max(any, sd.soft);
    if (sd.gas == 0.0) sd.gas = any;
    for (double* each : {&sd.gas, &sd.soft, &sd.tagged})
        *each = std::clamp(*each, 4.0, 100.0);
    return sd;
}

}  // namespace haustra::cleansing
