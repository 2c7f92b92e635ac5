// The pieces of a lumen that a collapsed or fluid-blocked colon falls into, and bridges between.
#pragma once

#include "core/volume.h"
#include "topology/digital_topology.h"
#include "topology/islands.h"

#include <string>
#include <vector>

namespace haustra::topology {

/// A lumen in one 6-connected piece without cavities, and a path through it.
struct JoinedLumen {
    explicit JoinedLumen(glm::ivec3 size) : domain(size), bridges(size) {}

    BitMask domain;
    BitMask bridges;           ///< of the domain, what joins the pieces
    Volume<float> distanceMm;  ///< distanceToBoundaryMm of the domain; sure ways are the deepest
    std::vector<glm::ivec3> path;
    long cavitiesFilled = 0, islandsTied = 0;
    std::vector<std::string> notes;
};

/// Of the tubes that join pieces.
inline constexpr double bridgeRadiusMm = 1.5;

struct LumenJoinOptions {
    double smallestPieceMl = 2.0;      ///< smaller pieces are left out, but for the largest; so are
                                       ///< all but the twelve largest
    const BitMask* sureWay = nullptr;  ///< voxels in which no way is too narrow: see joinPieces
    StalkTraces traces = {};
    int threads = 0;
};

/// Joins the 6-connected pieces of a mask worth a visit, in the order in which the colon passes
/// them (orderSegments), by straight tubes from tip to tip; what lies too far off the way and
/// small pieces are left out. Islands of background are tied to the wall or filled (islands.h). The
/// path is the
/// widest way between two far ends, piece by piece: the skeleton from which dissertation §3.3.2.2
/// grows the lumen; 6-connected where the lumen lets it be.
///
/// Voxels of `sureWay` count as deep as any: a bridge that the segmentation laid across a collapse
/// is thin as it is drawn, not as the colon is, and so are the tips that taper towards it. Where
/// lumen leads around it too, that is a leak, as the chain has no two ways to one place; so a
/// handle through a bridge is cut elsewhere, but for a leak over 4 mm in radius, which beats the
/// tips.
///
/// `mask` has at least one voxel and is on `grid`. The same for any number of threads.
/// O(n log n) in the voxels of the mask, and linear in the grid's.
JoinedLumen joinPieces(const BitMask& mask, const Grid& grid, const LumenJoinOptions& options = {});

}  // namespace haustra::topology
