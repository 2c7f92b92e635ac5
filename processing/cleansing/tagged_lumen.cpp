#include "cleansing/tagged_lumen.h"

#include "cleansing/menisci.h"
#include "core/parallel.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace haustra::cleansing {
namespace {

// How far measuring looks beyond the labels: in mm, a sample of noise beside tagging (a block of
// 6 mm, the length of a second difference, a ball); in voxels, a line through a face.
constexpr double marginMm = 20.0;
constexpr int marginVoxels = 8;

/// The box of what is labelled and its surroundings; empty where nothing is tagged.
VoxelBox boxOf(const Volume<std::uint8_t>& segmentation, int threads) {
    const Grid& grid = segmentation.grid();
    struct Slice {
        glm::ivec3 lo, hi;
        bool tagged = false;
    };
    std::vector<Slice> slices(std::size_t(grid.size.z), {grid.size, glm::ivec3(-1)});
    parallelFor(slices.size(), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            Slice& slice = slices[k];
            for (int j = 0; j < grid.size.y; ++j) {
                const auto row = segmentation.voxels().subspan(grid.index(0, j, int(k)),
                                                               std::size_t(grid.size.x));
                const auto isSet = [](std::uint8_t label) { return label != 0; };
                const auto first = std::find_if(row.begin(), row.end(), isSet);
                if (first == row.end()) continue;
                const auto last = std::find_if(row.rbegin(), row.rend(), isSet).base() - 1;
                slice.lo = glm::min(slice.lo, glm::ivec3(first - row.begin(), j, k));
                slice.hi = glm::max(slice.hi, glm::ivec3(last - row.begin(), j, k));
                slice.tagged =
                    slice.tagged ||
                    std::find(first, row.end(), std::uint8_t(LumenLabel::tagged)) != row.end();
            }
        }
    });
    Slice all{grid.size, glm::ivec3(-1)};
    for (const Slice& slice : slices) {
        all.lo = glm::min(all.lo, slice.lo), all.hi = glm::max(all.hi, slice.hi);
        all.tagged = all.tagged || slice.tagged;
    }
    if (!all.tagged) return {};
    const VoxelBox box =
        boxWithin(grid, all.lo, all.hi, marginMm + double(marginVoxels) * grid.spacingMm());
    // Whole cells before the labels, so that where the colon lies in the scan changes nothing; as
    // much as there is where they do not fit.
    const glm::ivec3 cell = cellVoxels(grid),
                     fitting = all.lo - (all.lo - box.lo + cell - 1) / cell * cell,
                     lo = glm::mix(fitting, glm::ivec3(0), glm::lessThan(fitting, glm::ivec3(0)));
    return {lo, box.lo + box.size - lo};
}

}  // namespace

Result<std::optional<LumenPart>> cropToLumen(const CtScan& scan,
                                             const Volume<std::uint8_t>& segmentation,
                                             int threads) {
    const Grid& grid = scan.hu.grid();
    if (!sameGrid(grid, segmentation.grid())) {
        return fail(ErrorKind::badInput, "the segmentation is not on the scan's grid",
                    "tagged lumen");
    }
    const VoxelBox box = boxOf(segmentation, threads);
    if (box.size == glm::ivec3(0)) return std::nullopt;
    if (cropped(grid, box).voxelCount() > std::numeric_limits<std::uint32_t>::max()) {
        return fail(ErrorKind::unsupported, "the colon's surroundings have more than 2^32 voxels",
                    "tagged lumen");
    }
    return LumenPart{grid,
                     box,
                     {croppedCopy(scan.hu, box, threads), scan.position},
                     croppedCopy(segmentation, box, threads)};
}

TaggedLumen measureTaggedLumen(LumenPart part, const TissueModel& tissue, int threads) {
    TaggedLumen lumen;
    lumen.scanGrid = part.scanGrid, lumen.box = part.box;
    const glm::ivec3 from = lumen.box.lo;
    lumen.scan = std::move(part.scan);
    LabelledMenisci menisci = withMenisci(lumen.scan, tissue, part.labels);
    part.labels = {};
    lumen.labels = std::move(menisci.labels), lumen.menisci = std::move(menisci.added);
    lumen.around = taggedSurroundings(lumen.labels, threads);
    lumen.enhancement =
        measurePseudoEnhancement(lumen.scan, tissue, lumen.labels, lumen.scanGrid, from, threads);
    if (lumen.enhancement) {
        const Grid& grid = lumen.scan.hu.grid();
        const auto hu = lumen.scan.hu.writable();
        parallelFor(std::size_t(grid.size.z), 4, threads, [&](std::size_t begin, std::size_t end) {
            for (int k = int(begin); k < int(end); ++k) {
                for (int j = 0; j < grid.size.y; ++j) {
                    lumen.enhancement.takeOff(
                        from + glm::ivec3(0, j, k),
                        hu.subspan(grid.index(0, j, k), std::size_t(grid.size.x)));
                }
            }
        });
    }
    lumen.means = measureLocalMeans(lumen.scan, tissue, lumen.labels, lumen.around, threads);
    return lumen;
}

}  // namespace haustra::cleansing
