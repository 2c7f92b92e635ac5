#include "cleansing/tagged_surroundings.h"

#include "cleansing/ball.h"
#include "core/ct_scan.h"
#include "core/voxel_sweep.h"

#include <algorithm>

namespace haustra::cleansing {

TaggedSurroundings taggedSurroundings(const Volume<std::uint8_t>& segmentation, int threads) {
    const Grid& grid = segmentation.grid();
    const auto label = segmentation.voxels();
    // Slice by slice, so that the order is that of memory whatever the threads.
    std::vector<std::vector<std::uint32_t>> slices(std::size_t(grid.size.z));
    parallelFor(slices.size(), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t first = grid.index(0, 0, int(k));
            const std::size_t last = first + std::size_t(grid.size.x) * std::size_t(grid.size.y);
            for (std::size_t n = first; n < last; ++n) {
                if (LumenLabel(label[n]) == LumenLabel::tagged)
                    slices[k].push_back(std::uint32_t(n));
            }
        }
    });
    TaggedSurroundings around;
    const glm::ivec3 reach = blurReachVoxels(grid);
    const int steps = std::max({reach.x, reach.y, reach.z});
    const glm::dvec3 spacing = grid.spacingMm();
    around.shells.resize(std::size_t(steps) + 1);
    around.besideShells =
        std::max(1, int(std::lround(0.75 / std::min({spacing.x, spacing.y, spacing.z}))));
    Volume<std::uint8_t> seenVoxels(grid, std::uint8_t(0));
    const auto seen = seenVoxels.writable();
    for (const auto& slice : slices)
        around.shells[0].insert(around.shells[0].end(), slice.begin(), slice.end());
    for (std::uint32_t n : around.shells[0])
        seen[n] = 1;
    for (std::size_t shell = 1; shell < around.shells.size(); ++shell) {
        auto& out = around.shells[shell];
        // An axis' steps are spread over the shells.
        const glm::ivec3 side = reach * int(shell) / steps - reach * int(shell - 1) / steps;
        for (std::uint32_t n : around.shells[shell - 1]) {
            const glm::ivec3 v = grid.voxelAt(n);
            const glm::ivec3 lo = glm::max(v - side, glm::ivec3(0)),
                             hi = glm::min(v + side, grid.size - 1);
            visitBox(lo, hi, [&](glm::ivec3 beside) {
                const std::size_t m = grid.index(beside);
                if (seen[m]) return;
                seen[m] = 1;
                out.push_back(std::uint32_t(m));
            });
        }
        std::sort(out.begin(), out.end());
    }
    return around;
}

}  // namespace haustra::cleansing
