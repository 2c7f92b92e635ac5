#include "topology/handle_cutting.h"

#include "core/crop.h"
#include "topology/ball_growth.h"
#include "topology/lumen_pieces.h"

#include <algorithm>

namespace haustra::topology {
namespace {

// What an empty scanner measures.
constexpr double emptyHu = -1000.0;

/// The voxels with a label other than 0, and `marginMm` more where the grid has them.
VoxelBox boxAround(const BitMask& mask, const Grid& grid, double marginMm) {
    glm::ivec3 lo = grid.size, hi(-1);
    for (int k = 0; k < grid.size.z; ++k) {
        for (int j = 0; j < grid.size.y; ++j) {
            const std::uint64_t* row = mask.row(j, k);
            for (std::size_t w = 0; w < mask.rowWords(); ++w) {
                if (!row[w]) continue;
                const int first = int(w * 64) + std::countr_zero(row[w]) - 1;
                const int last = int(w * 64) + 62 - std::countl_zero(row[w]);
                lo = glm::min(lo, glm::ivec3(first, j, k));
                hi = glm::max(hi, glm::ivec3(last, j, k));
            }
        }
    }
    const glm::ivec3 margin = glm::ivec3(glm::ceil(marginMm / grid.spacingMm())) + 1;
    lo = glm::max(lo - margin, glm::ivec3(0));
    hi = glm::min(hi + margin, grid.size - 1);
    return {lo, hi - lo + 1};
}

BitMask bridgesOf(const Volume<std::uint8_t>& labels) {
    BitMask bridges(labels.grid().size);
    for (std::size_t n = 0; n < labels.voxels().size(); ++n) {
        if (LumenLabel(labels[n]) == LumenLabel::bridge) bridges.set(labels.grid().voxelAt(n));
    }
    return bridges;
}

}  // namespace

Result<CutLumen> cutHandles(const Volume<std::uint8_t>& labels,
                            const HandleCuttingOptions& options) {
    const Grid& grid = labels.grid();
    const auto progress = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    if (options.hu && !sameGrid(options.hu->grid(), grid))
        return fail(ErrorKind::badInput, "the scan is not on the labels' grid", "handle cutting");
    VoxelBox box;
    {
        const BitMask mask = maskOf(labels, options.threads);
        if (mask.count() == 0)
            return fail(ErrorKind::noResult, "the lumen is empty", "handle cutting");
        box = boxAround(mask, grid, bridgeRadiusMm);
    }
    const Volume<std::uint8_t> part = croppedCopy(labels, box, options.threads);
    const BitMask mask = maskOf(part, options.threads);
    const BitMask bridges = bridgesOf(part);
    JoinedLumen joined = joinPieces(mask, part.grid(),
                                    {.sureWay = bridges.count() > 0 ? &bridges : nullptr,
                                     .traces = {options.hu, box.lo, emptyHu, options.wallHu},
                                     .threads = options.threads});
    progress(0.3);
    const BitMask ball = growBall(joined.domain, joined.distanceMm, joined.path,
                                  [&](double done) { progress(0.3 + 0.65 * done); });

    CutLumen cut;
    cut.handlesCut = digitalTopology(joined.domain, options.threads).handles();
    cut.cavitiesFilled = joined.cavitiesFilled, cut.islandsTied = joined.islandsTied;
    cut.notes = std::move(joined.notes);
    cut.labels = Volume<std::uint8_t>(grid, std::uint8_t(LumenLabel::outside));
    for (int k = 0; k < box.size.z; ++k) {
        for (int j = 0; j < box.size.y; ++j) {
            const std::uint8_t* before = part.voxels().data() + part.grid().index(0, j, k);
            std::uint8_t* after =
                cut.labels.writable().data() + grid.index(box.lo + glm::ivec3(0, j, k));
            auto filling = std::uint8_t(LumenLabel::air);
            for (int i = 0; i < box.size.x; ++i) {
                const glm::ivec3 v(i, j, k);
                if (before[i] != 0) filling = before[i];
                if (!ball.test(v)) {
                    cut.voxelsRemoved += before[i] != 0;
                    continue;
                }
                cut.voxelsAdded += before[i] == 0;
                after[i] = before[i] != 0           ? before[i]
                           : joined.bridges.test(v) ? std::uint8_t(LumenLabel::bridge)
                                                    : filling;
            }
        }
    }
    progress(1.0);
    return cut;
}

}  // namespace haustra::topology
