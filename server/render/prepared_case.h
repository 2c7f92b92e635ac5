// What a case's renderer is made from beside the scan, computed without a GPU.
#pragma once

#include "core/ct_scan.h"
#include "render/leap_map.h"

#include <cstdint>

namespace haustra::render {

/// Longest side of a scan that is drawn, voxels; a device may allow less.
inline constexpr int maxScanSide = 2048;

/// Everything of a renderer that takes long to compute.
struct PreparedCase {
    /// The scan with its tagged lumen taken for air; empty where none is tagged.
    Volume<std::int16_t> cleared;
    BlockRanges ranges;  ///< of the volume that the endoscopic view shows
};

/// `ct` is the scan; `lumen` (LumenLabel, on the same grid, may be empty) tells which tagged
/// voxels the endoscopic view shows as air. `threads` (≤ 0: all cores) changes no value. Fails
/// (badInput) where the grids are not sound or not the same, (device) where a side is too long.
/// O(voxels), a second or two for 512³; reads every page of a memory-mapped scan. Any thread.
Result<PreparedCase> prepareCase(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& lumen,
                                 int threads = 0);

/// Fails (device) where a side of the grid is longer than `most` voxels.
Result<void> checkScanSide(const Grid& grid, int most);

}  // namespace haustra::render
