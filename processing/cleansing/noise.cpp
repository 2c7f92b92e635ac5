#include "cleansing/noise.h"

#include "cleansing/ball.h"
#include "cleansing/near_blocks.h"

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

/// Second differences.
class Differences {
public:
    Differences(const CtScan& scan, int threads)
        : hu_(scan.hu),
          grid_(scan.hu.grid()),
          ball_(blurBall(grid_)),
          apart_(glm::ceil(apartMm / grid_.spacingMm())),
          threads_(threads) {}

    /// Their standard deviation about the voxels that are `wanted` and of a material, `is(index)`,
    /// which has about so many voxels; 0 where there are too few.
    template <class Wanted, class Is>
    double sd(std::size_t voxels, const Wanted& wanted, const Is& is) const {
        const int every = std::max(
            {1, int(std::lround(sampleMm3 / grid_.voxelVolumeMm3())), int(voxels / samples)});
        Counts counts{};
        std::mutex mutex;
        parallelFor(std::size_t(grid_.size.z), 4, threads_,
                    [&](std::size_t begin, std::size_t end) {
                        Counts some{};
                        for (int k = int(begin); k < int(end); ++k)
                            addSlice(k, every, wanted, is, some);
                        const std::lock_guard lock(mutex);  // integers: in any order
                        for (std::size_t d = 0; d < counts.size(); ++d)
                            counts[d] += some[d];
                    });
        std::uint64_t total = 0;
        for (const std::uint32_t count : counts)
            total += count;
        return total < fewest ? 0.0 : standardDeviation(counts);
    }

private:
    template <class Wanted, class Is>
    void addSlice(int k, int every, const Wanted& wanted, const Is& is, Counts& counts) const {
        for (int j = 0; j < grid_.size.y; ++j) {
            const int first = firstSample(j + 2 * k, every);
            for (int i = first; i < grid_.size.x; i += every) {
                const glm::ivec3 v(i, j, k);
                if (wanted(v) && isDeep(v, is)) addAbout(v, is, counts);
            }
        }
    }

    /// The voxel and all that the blur reaches is of the material.
    template <class Is>
    bool isDeep(glm::ivec3 v, const Is& is) const {
        return is(grid_.index(v)) && ball_.everywhere(v, is);
    }

    template <class Is>
    void addAbout(glm::ivec3 v, const Is& is, Counts& counts) const {
        for (int axis = 0; axis < 2; ++axis) {
            glm::ivec3 step(0);
            step[axis] = apart_[axis];
            if (!grid_.contains(v - step) || !grid_.contains(v + step) || !isDeep(v - step, is) ||
                !isDeep(v + step, is))
                continue;
            const int d = std::abs(hu_.at(v - step) - 2 * hu_.at(v) + hu_.at(v + step));
            if (d < farthest) ++counts[std::size_t(d)];
        }
    }

    const Volume<std::int16_t>& hu_;
    const Grid& grid_;
    const Ball ball_;
    const glm::ivec3 apart_;
    const int threads_;
};

/// What could not be measured is as another material's.
NoiseSd completed(NoiseSd sd, double otherwise) {
    const double any = sd.gas > 0.0      ? sd.gas
                       : sd.tagged > 0.0 ? sd.tagged
                       : sd.soft > 0.0   ? sd.soft
                                         : otherwise;
    if (sd.soft == 0.0) sd.soft = std::max(any, sd.tagged);
    if (sd.tagged == 0.0) sd.tagged = std::max(any, sd.soft);
    if (sd.gas == 0.0) sd.gas = any;
    for (double* each : {&sd.gas, &sd.soft, &sd.tagged})
        *each = std::clamp(*each, 4.0, 100.0);
    return sd;
}

}  // namespace

NoiseSd measureNoise(const CtScan& scan, const TissueModel& tissue,
                     const Volume<std::uint8_t>& segmentation, int threads) {
    const Differences differences(scan, threads);
    const auto ofLabel = [&](LumenLabel label) {
        const auto all = segmentation.voxels();
        return differences.sd(
            std::size_t(std::count(all.begin(), all.end(), std::uint8_t(label))),
            [](glm::ivec3) { return true; },
            [&](std::size_t n) { return LumenLabel(segmentation[n]) == label; });
    };
    NoiseSd sd;
    sd.gas = ofLabel(LumenLabel::air);
    sd.tagged = ofLabel(LumenLabel::tagged);
    // Wide enough that the window cuts off none of the noise.
    const double softHu = tissue.meanHu[int(Tissue::soft)],
                 window = std::max(70.0, 4.5 * std::max(sd.gas, sd.tagged));
    const NearBlocks near(
        segmentation, voxelsIn(segmentation.grid(), apartFromTaggingMm),
        [](std::uint8_t label) { return LumenLabel(label) == LumenLabel::tagged; });
    sd.soft = differences.sd(
        near.voxelCount() / 4, [&](glm::ivec3 v) { return near.hold(v); },
        [&](std::size_t n) {
            return segmentation[n] == 0 && std::abs(scan.hu[n] - softHu) < window;
        });
    return completed(sd, tissue.sdHu[int(Tissue::soft)]);
}

}  // namespace haustra::cleansing
