// Where nobody has seen the wall: bridges across stretches of colon that are collapsed or filled.
#pragma once

#include "core/centerline.h"
#include "core/tri_mesh.h"
#include "core/volume.h"

#include <cstdint>
#include <vector>

namespace haustra {

/// A stretch of the path that runs through tissue (CenterlinePoint::gap), from where the one
/// segment of the lumen ends to where the next begins.
struct Bridge {
    double fromArcMm = 0.0, toArcMm = 0.0;
    double lengthMm() const { return toArcMm - fromArcMm; }
};

/// The bridges of a path, in its order; their ends are midway between samples. O(n).
std::vector<Bridge> bridgesOf(const Centerline& centerline);

/// For each triangle of the lumen's wall (counter-clockwise seen from outside) 1 where it encloses
/// a bridge, no bowel that was seen, else 0: the first voxel of `lumen` (LumenLabel) that is not
/// outside, going inwards from the triangle's middle, is labelled bridge. It is looked for no
/// deeper than two voxels, since the wall stands between voxels; where there is none, the triangle
/// encloses no bridge. Works on a flat map's cut surface too. Indices must be in range.
/// O(triangles); touches the voxels near the wall alone. Thread-safe.
std::vector<std::uint8_t> bridgedTriangles(const TriMesh& wall, const Volume<std::uint8_t>& lumen);

}  // namespace haustra
