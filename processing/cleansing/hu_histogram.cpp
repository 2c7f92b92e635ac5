#include "cleansing/hu_histogram.h"

#include "core/parallel.h"

#include <algorithm>
#include <cstdint>
#include <mutex>

namespace haustra::cleansing {

std::vector<double> huHistogram(const CtScan& scan, int threads) {
    constexpr std::size_t binCount = highestHu - lowestHu + 1;
    std::vector<double> histogram(binCount, 0.0);
    std::mutex mutex;
    const auto voxels = scan.hu.voxels();
    parallelFor(
        voxels.size(), std::size_t(1) << 22, threads, [&](std::size_t begin, std::size_t end) {
            std::vector<std::uint32_t> counts(binCount, 0);
            for (std::size_t n = begin; n < end; ++n) {
                if (voxels[n] > lowestHu)
                    ++counts[std::size_t(std::min<int>(voxels[n], highestHu) - lowestHu)];
            }
            const std::lock_guard lock(mutex);  // sums of integers: the order does not matter
            for (std::size_t bin = 0; bin < binCount; ++bin)
                histogram[bin] += counts[bin];
        });
    return histogram;
}

}  // namespace haustra::cleansing
