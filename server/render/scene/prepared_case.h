// What a case's renderer is made from, computed without a GPU.
#pragma once

#include "core/centerline.h"
#include "core/flat_map.h"
#include "core/tri_mesh.h"
#include "core/volume.h"
#include "render/optics/leap_map.h"

#include <cstdint>
#include <memory>

namespace haustra::render {

/// Longest side of a scan that is drawn from a texture of its own, voxels; a device may allow less.
inline constexpr int maxScanSide = 2048;
/// Most voxels of a scan whose blocks' ranges are kept: with more, it may not fit into main memory
/// either, and only the object-order raycaster draws it.
inline constexpr std::size_t maxRangedVoxels = std::size_t(1) << 31;

/// A case's volumes, and what takes long to compute from them.
struct PreparedCase {
    Volume<std::int16_t> ct;
    /// The scan after digital cleansing, which the endoscopic view shows; empty where there is
    /// none. Where cleansing has changed nothing, this is `ct`, in the same memory.
    Volume<std::int16_t> cleansed;
    /// Of the volume that the endoscopic view shows; empty where it has more than maxRangedVoxels.
    BlockRanges ranges;
    /// For the flattened views; empty where the case has none. prepareCase leaves it empty.
    std::shared_ptr<const FlatMap> flatMap;
    /// The wall's mesh, for raycasters and views that use it; as with flatMap.
    std::shared_ptr<const TriMesh> wall;
    /// The path through the colon, for the overview; as with flatMap.
    std::shared_ptr<const Centerline> path;

    const Volume<std::int16_t>& endoscopic() const { return cleansed.empty() ? ct : cleansed; }
};

/// Takes handles on `ct` and `cleansed` (which may be empty), HU on the same grid. `threads` (≤ 0:
/// all cores) changes no value. Fails (badInput) where the grids are not sound or not the same.
/// O(voxels), under a second for 512³; reads every page of
/// memory-mapped volumes, and adds 1/2 byte a voxel of main memory. Any thread.
Result<PreparedCase> prepareCase(const Volume<std::int16_t>& ct,
                                 const Volume<std::int16_t>& cleansed, int threads = 0);

/// Fails (device) where a side of the grid is longer than `most` voxels.
Result<void> checkScanSide(const Grid& grid, int most);

}  // namespace haustra::render
