// What raycasters draw: immutable, in main memory or mapped from a product.
#pragma once

#include "core/centerline.h"
#include "core/flat_map.h"
#include "core/tri_mesh.h"
#include "core/volume.h"
#include "render/optics/leap_map.h"

#include <cstdint>
#include <memory>

namespace haustra::render {

/// One volume and what goes with it. Shared by raycasters and threads.
struct Scene {
    Volume<std::int16_t> volume;  ///< HU; what rays are cast into
    BlockRanges ranges;           ///< of `volume`
    /// The wall's mesh, for the polygon-assisted raycaster and the overview, and the same wall's
    /// flat map; either may be missing.
    std::shared_ptr<const TriMesh> wall;
    std::shared_ptr<const FlatMap> flatMap;
    std::shared_ptr<const Centerline> path;  ///< for the overview; may be missing

    const Grid& grid() const { return volume.grid(); }
};

}  // namespace haustra::render
