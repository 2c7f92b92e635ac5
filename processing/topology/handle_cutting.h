// Volume-based topological denoising (dissertation §3.3.2.2): from a lumen with handles to a ball.
#pragma once

#include "core/ct_scan.h"
#include "core/parallel.h"
#include "core/result.h"
#include "topology/digital_topology.h"

#include <string>
#include <vector>

namespace haustra::topology {

struct HandleCuttingOptions {
    /// The scan that the labels were found in, on their grid; null: none. Islands are tied where it
    /// shows a trace of a stalk; all of a wall is at `wallHu`.
    const Volume<std::int16_t>* hu = nullptr;
    double wallHu = -500.0;
    int threads = 0;
    Progress progress = {};
};

struct CutLumen {
    Volume<std::uint8_t> labels;  ///< LumenLabel; a ball by the (6, 18) and the (6, 26) pair
    /// By the (6, 18) pair: what an open corner alone makes is in `voxelsRemoved`.
    long handlesCut = 0, cavitiesFilled = 0, islandsTied = 0;
    std::size_t voxelsRemoved = 0, voxelsAdded = 0;  ///< against the labels that came in
    std::vector<std::string> notes;
};

/// The largest-distance-first region growing of §3.3.2.2 from a path through the lumen, adding
/// simple points alone, so that each handle is cut where it is thinnest (growBall), but not at a
/// voxel labelled bridge: what leads around a collapse that the segmentation crossed is a leak,
/// however wide (joinPieces). Large pieces of
/// the lumen are joined by thin bridges, labelled so, in the order in which the colon passes them;
/// small pieces, and those too far off the way, are left out (joinPieces). Islands of background
/// that float in the lumen are tied to the wall, or filled with the label of the voxel before them
/// on their row (tieOrFillIslands). What is left out, joined, tied or filled is in `notes`.
///
/// Distances count in units of the grid's smallest spacing: T_th is below the least distance a
/// voxel can have, so that nothing is left out for being thin. Fails where the lumen is empty
/// (noResult), or the scan is on another grid (badInput). The same bytes for any number of threads.
/// O(n log n) in the lumen's voxels; takes about 6 bytes for each voxel of the lumen's bounding
/// box, beside the result.
Result<CutLumen> cutHandles(const Volume<std::uint8_t>& labels,
                            const HandleCuttingOptions& options = {});

}  // namespace haustra::topology
