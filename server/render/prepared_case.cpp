#include "render/prepared_case.h"

#include "render/lumen_as_air.h"

#include <algorithm>
#include <string>

namespace haustra::render {

Result<void> checkScanSide(const Grid& grid, int most) {
    const glm::ivec3 size = grid.size;
    if (std::max(size.x, std::max(size.y, size.z)) <= most) return {};
    return fail(ErrorKind::device,
                "a scan of " + std::to_string(size.x) + "x" + std::to_string(size.y) + "x" +
                    std::to_string(size.z) + " voxels has a side over " + std::to_string(most) +
                    ", the longest that is drawn",
                "render");
}

Result<PreparedCase> prepareCase(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& lumen,
                                 int threads) {
    const Grid& grid = ct.grid();
    if (Result<void> sound = checkGrid(grid, "ct"); !sound)
        return tl::make_unexpected(sound.error());
    if (!lumen.empty() && !sameGrid(grid, lumen.grid()))
        return fail(ErrorKind::badInput, "the lumen is not on the scan's grid", "render");
    if (Result<void> fits = checkScanSide(grid, maxScanSide); !fits)
        return tl::make_unexpected(fits.error());

    const auto labels = lumen.voxels();
    const bool tagged =
        std::find(labels.begin(), labels.end(), std::uint8_t(LumenLabel::tagged)) != labels.end();
    PreparedCase prepared;
    if (tagged) prepared.cleared = lumenAsAir(ct, lumen, threads);
    prepared.ranges = blockRanges(tagged ? prepared.cleared : ct, threads);
    return prepared;
}

}  // namespace haustra::render
