// The lumen's surface at sub-voxel accuracy, with the topology of its voxels.
#pragma once

#include "core/ct_scan.h"
#include "core/result.h"
#include "core/tri_mesh.h"

namespace haustra::surface {

struct ContouringOptions {
    int threads = 0;
};

/// Dual contouring with the enhanced cell representation (dissertation §3.4, Zhang et al. [139]):
/// inside is `lumen` ≠ 0 as 6-connected voxels (outside 18-connected), so that a lumen that is a
/// ball gives a closed manifold of genus 0; where inside meets outside, the surface stands where
/// `hu` crosses `isoHu` between the two voxel centres, or midway where it does not cross there.
/// Vertices minimise the quadric of the crossings and their HU gradients within their cell.
/// Triangles are counter-clockwise seen from outside the lumen, in LPS mm; none intersect.
/// Fails where the grids differ (badInput) or the lumen is empty (noResult). The same mesh for any
/// number of threads.
Result<TriMesh> contourLumen(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& lumen,
                             double isoHu, const ContouringOptions& options = {});

}  // namespace haustra::surface
