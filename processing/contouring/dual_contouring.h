// The lumen's surface at sub-voxel accuracy, with the topology of its voxels.
#pragma once

#include "core/ct_scan.h"
#include "core/result.h"
#include "core/tri_mesh.h"

namespace haustra::contouring {

struct ContouringOptions {
    int threads = 0;
};

/// Dual contouring with the enhanced cell representation (dissertation §3.4, Zhang et al. [139]):
/// inside is `lumen` ≠ 0 as 6-connected voxels, outside (and all beyond the grid) 18-connected. For
/// any labels and any HU the mesh is closed and manifold, its Euler characteristic twice that of
/// the labels' solid, and no two triangles intersect: a lumen that is a ball gives a sphere.
///
/// Where inside meets outside, the surface stands where `hu` crosses `isoHu` between the two voxel
/// centres; where it does not cross there (a handle was cut, a collapse bridged) it is the
/// smoothest sheet that the labels allow. No vertex leaves the cube between eight voxel centres
/// that holds its part of the labels' boundary. A curved wall is drawn inwards by what the
/// scanner's blur of standard deviation σ does to the half-way HU: σ²/R on a ball of radius R.
///
/// Triangles are counter-clockwise seen from outside the lumen, for mirrored grids as well, in LPS
/// mm. Fails where the grids differ (badInput) or the lumen is empty (noResult). O(voxels +
/// triangles): a second for two million triangles; takes about 250 bytes a vertex. Thread-safe; the
/// same mesh for any number of threads.
Result<TriMesh> contourLumen(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& lumen,
                             double isoHu, const ContouringOptions& options = {});

}  // namespace haustra::contouring
