// Ways through collapsed bowel: from one blind end to another, in soft tissue.
#pragma once

#include "segmentation/bowel_contents.h"
#include "segmentation/tube_pieces.h"

#include <vector>

namespace haustra::segmentation {

/// A way from the tip of one piece to another piece.
struct CollapsePath {
    std::int32_t from = 0, to = 0;  ///< pieces
    double costMm = 0.0, lengthMm = 0.0;
    bool toTip = false;  ///< it ends at a tip, not at a side
    double turn =
        0.0;  ///< (1 − cos) of the angle by which it leaves the bowel's axis, both ends' sum
    std::vector<glm::dvec3> pointsMm;  ///< from a voxel of `from` to one of `to`
};

struct CollapseOptions {
    double mostCostMm = 90.0;
    int threads = 0;
};

/// The cheapest way from each piece's blind ends to each other piece within reach. A collapsed
/// colon is a cord of soft tissue of 8 to 18 mm: a millimetre of it costs 1, of fat 6, of soft
/// tissue more than 10 mm deep in an organ more with its depth, and 1 more within a cell (2.5 mm)
/// of other lumen, since the cord's own wall and the other's lie between; gas, bone, tagged
/// material, the room's air and lung are no way at all. `candidates` are the pieces that count,
/// `doors` the places where each is open to others. Dijkstra on cells of 2.5 mm.
std::vector<CollapsePath> findCollapsePaths(const Volume<std::int16_t>& hu,
                                            const BowelContents& contents, const TubePieces& cut,
                                            const std::vector<std::int32_t>& candidates,
                                            const std::vector<std::vector<glm::ivec3>>& doors,
                                            const CollapseOptions& options);

}  // namespace haustra::segmentation
