#include "render/scene/prepared_case.h"

#include <algorithm>
#include <string>

namespace haustra::render {

Result<void> checkScanSide(const Grid& grid, int most) {
    const glm::ivec3 size = grid.size;
    if (std::max(size.x, std::max(size.y, size.z)) <= most) return {};
    return fail(ErrorKind::device,
                "a scan of " + std::to_string(size.x) + "x" + std::to_string(size.y) + "x" +
                    std::to_string(size.z) + " voxels has a side over " + std::to_string(most) +
                    ", the longest that is drawn from one texture",
                "render");
}

Result<PreparedCase> prepareCase(const Volume<std::int16_t>& ct,
                                 const Volume<std::int16_t>& cleansed, int threads) {
    const Grid& grid = ct.grid();
    TRY(checkGrid(grid, "ct"));
    if (!cleansed.empty() && !sameGrid(grid, cleansed.grid()))
        return fail(ErrorKind::badInput, "the cleansed scan is not on the scan's grid", "render");
    PreparedCase prepared;
    prepared.ct = ct.share();
    if (!cleansed.empty()) {
        const auto before = ct.voxels(), after = cleansed.voxels();
        const bool unchanged = std::equal(before.begin(), before.end(), after.begin());
        prepared.cleansed = (unchanged ? ct : cleansed).share();
    }
    if (grid.voxelCount() <= maxRangedVoxels)
        prepared.ranges = blockRanges(prepared.endoscopic(), blockSide, threads);
    return prepared;
}

}  // namespace haustra::render
