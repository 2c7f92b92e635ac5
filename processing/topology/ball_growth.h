// Growing a ball inside a mask (dissertation §3.3.2.2): simple points alone, the deepest first.
#pragma once

#include "core/parallel.h"
#include "core/volume.h"
#include "topology/bit_mask.h"

#include <cstddef>
#include <vector>

namespace haustra::topology {

inline constexpr double priorityStep = 0.1;       ///< δ: what a voxel that is not simple falls by
inline constexpr double priorityThreshold = 0.8;  ///< T_th: below it the voxel is left out

/// A subset of `domain` with the topology of a ball by construction: it begins with one voxel and
/// every other is added as a simple point. The dissertation asks that of the (6, 18) pair; it is
/// asked of the (6, 26) pair, too, so that whoever joins the background through corners counts no
/// handle either.
///
/// First `path` is followed as far as it is 6-connected and each voxel simple; then the domain's
/// voxels that the ball reaches are taken in order of priority, which is the distance to the
/// boundary in 1/1024 of the grid's smallest spacing, the first to be reached first among equals.
/// So two fronts meet, and the one that comes second stops, where a handle is thinnest. A voxel
/// that is not simple is tried again at δ less down to T_th; every voxel of the domain has a
/// priority of 1 or more, whatever the spacing, so nothing thin is left out for being thin. In the
/// end what has become simple since is taken, until no voxel left of the domain is simple.
///
/// `path` must not be empty and its first voxel be in the domain; `distanceMm` is
/// distanceToBoundaryMm(domain), or more where no handle is to be cut. Linear in the domain's
/// voxels but for those tried again; one thread.
BitMask growBall(const BitMask& domain, const Volume<float>& distanceMm,
                 const std::vector<glm::ivec3>& path, const Progress& progress = {});

}  // namespace haustra::topology
