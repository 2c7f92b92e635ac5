#include "contouring/wall_field.h"

#include "core/parallel.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <vector>

namespace haustra::contouring {
namespace {

constexpr int reach = 2;
constexpr std::array<int, 2 * reach + 1> binomial = {1, 4, 6, 4, 1};  // sums to 16
constexpr double leastContrastHu = 10.0;

// One slice smoothed along i and j: 0 all inside … 256 all outside.
void smoothSlice(const Volume<std::uint8_t>& labels, int k, std::vector<int>& alongI,
                 std::vector<int>& smooth) {
    const glm::ivec3 size = labels.grid().size;
    const auto at = [&](int i, int j) {
        return std::size_t(i) + std::size_t(size.x) * std::size_t(j);
    };
    for (int j = 0; j < size.y; ++j) {
        for (int i = 0; i < size.x; ++i) {
            int sum = 0;
            for (int d = -reach; d <= reach; ++d) {
                if (labels.at(std::clamp(i + d, 0, size.x - 1), j, k) == 0)
                    sum += binomial[std::size_t(d + reach)];
            }
            alongI[at(i, j)] = sum;
        }
    }
    for (int j = 0; j < size.y; ++j) {
        for (int i = 0; i < size.x; ++i) {
            int sum = 0;
            for (int d = -reach; d <= reach; ++d) {
                sum += binomial[std::size_t(d + reach)] *
                       alongI[at(i, std::clamp(j + d, 0, size.y - 1))];
            }
            smooth[at(i, j)] = sum;
        }
    }
}

using Histogram = std::vector<std::uint64_t>;  // of all int16 values

std::size_t binOf(std::int16_t hu) {
    return std::size_t(int(hu) - std::numeric_limits<std::int16_t>::min());
}

std::uint64_t countOf(const Histogram& histogram) {
    std::uint64_t count = 0;
    for (const std::uint64_t n : histogram)
        count += n;
    return count;
}

double medianOf(const Histogram& histogram) {
    const std::uint64_t half = (countOf(histogram) + 1) / 2;
    std::uint64_t below = 0;
    std::size_t bin = 0;
    while (bin + 1 < histogram.size() && (below += histogram[bin]) < half)
        ++bin;
    return double(bin) + std::numeric_limits<std::int16_t>::min();
}

struct WallHistograms {
    Histogram inner = Histogram(65536), all = Histogram(65536), around = Histogram(65536);
    void add(const WallHistograms& other) {
        for (std::size_t bin = 0; bin < inner.size(); ++bin) {
            inner[bin] += other.inner[bin];
            all[bin] += other.all[bin];
            around[bin] += other.around[bin];
        }
    }
};

// Of slices [begin, end): inner voxels have six neighbours in the lumen; around it are the voxels
// two beyond a boundary voxel along an axis.
WallHistograms histogramsOf(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& labels,
                            std::size_t begin, std::size_t end) {
    const Grid& grid = labels.grid();
    WallHistograms histograms;
    visitSlices(grid, begin, end, [&](std::size_t n, glm::ivec3 v) {
        if (labels[n] == 0) return;
        ++histograms.all[binOf(hu[n])];
        bool inner = true;
        for (int axis = 0; axis < 3; ++axis) {
            for (const int sign : {-1, 1}) {
                glm::ivec3 step(0);
                step[axis] = sign;
                if (!grid.contains(v + step) || labels.at(v + step) != 0) continue;
                inner = false;
                const glm::ivec3 beyond = v + 3 * step;
                if (grid.contains(beyond) && labels.at(beyond) == 0)
                    ++histograms.around[binOf(hu.at(beyond))];
            }
        }
        if (inner) ++histograms.inner[binOf(hu[n])];
    });
    return histograms;
}

}  // namespace

WallField smoothedMask(const Volume<std::uint8_t>& labels, int threads) {
    const Grid& grid = labels.grid();
    WallField field{Volume<std::int16_t>(grid), 0.0, false};
    const std::size_t sliceVoxels = std::size_t(grid.size.x) * std::size_t(grid.size.y);
    const auto voxels = field.hu.writable();
    parallelFor(std::size_t(grid.size.z), 16, threads, [&](std::size_t begin, std::size_t end) {
        // A ring of the slices around the one that is made.
        std::array<std::vector<int>, 2 * reach + 1> ring;
        for (auto& slice : ring)
            slice.resize(sliceVoxels);
        std::vector<int> alongI(sliceVoxels);
        const auto ringAt = [&](int k) -> std::vector<int>& {
            return ring[std::size_t(k + reach) % ring.size()];
        };
        const auto fill = [&](int k) {
            smoothSlice(labels, std::clamp(k, 0, grid.size.z - 1), alongI, ringAt(k));
        };
        for (int k = int(begin) - reach; k < int(begin) + reach; ++k)
            fill(k);
        for (int k = int(begin); k < int(end); ++k) {
            fill(k + reach);
            for (std::size_t n = 0; n < sliceVoxels; ++n) {
                int sum = 0;  // 0…4096
                for (int d = -reach; d <= reach; ++d)
                    sum += binomial[std::size_t(d + reach)] * ringAt(k + d)[n];
                voxels[sliceVoxels * std::size_t(k) + n] =
                    std::int16_t((2000 * sum + 2048) / 4096 - 1000);
            }
        }
    });
    return field;
}

Result<WallField> contentField(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& labels,
                               int threads) {
    if (!sameGrid(hu.grid(), labels.grid())) {
        return fail(ErrorKind::badInput, "the scan and the lumen are not on one grid", "surface");
    }
    WallHistograms histograms;
    std::mutex mutex;
    parallelFor(std::size_t(hu.grid().size.z), 32, threads,
                [&](std::size_t begin, std::size_t end) {
                    const auto part = histogramsOf(hu, labels, begin, end);
                    const std::lock_guard lock(mutex);  // sums of integers: any order
                    histograms.add(part);
                });
    const Histogram& inside = countOf(histograms.inner) > 0 ? histograms.inner : histograms.all;
    if (countOf(inside) == 0) return fail(ErrorKind::noResult, "the lumen is empty", "surface");
    if (countOf(histograms.around) == 0) {
        return fail(ErrorKind::noResult, "the scan shows nothing around the lumen", "surface");
    }
    const double contentHu = medianOf(inside), aroundHu = medianOf(histograms.around);
    if (std::abs(contentHu - aroundHu) < leastContrastHu) {
        return fail(ErrorKind::noResult,
                    "the lumen's content hardly differs from what surrounds it", "surface");
    }
    const double isoHu = 0.5 * (contentHu + aroundHu);
    if (contentHu < aroundHu) return WallField{hu.share(), isoHu, false};
    WallField field{Volume<std::int16_t>(hu.grid()), -isoHu, true};
    const auto voxels = field.hu.writable();
    parallelFor(voxels.size(), std::size_t(1) << 20, threads,
                [&](std::size_t begin, std::size_t end) {
                    for (std::size_t n = begin; n < end; ++n)
                        voxels[n] = std::int16_t(std::min(-int(hu[n]), 32767));
                });
    return field;
}

}  // namespace haustra::contouring
