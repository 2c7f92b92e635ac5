// The pieces of a scan as the graph in which the colon's chain is searched.
#pragma once

#include "segmentation/body_frame.h"
#include "segmentation/bowel_contents.h"
#include "segmentation/collapse_paths.h"
#include "segmentation/colon_chain.h"
#include "segmentation/tube_pieces.h"

namespace haustra::segmentation {

struct PieceGraph {
    ChainGraph graph;
    std::vector<std::int32_t> pieceOf;  ///< of each node
    std::vector<std::int32_t> nodeOf;   ///< of each piece, or −1
    /// Pieces that may be fluid, and are no nodes. They are as wide and even as fluid, but brighter
    /// than that under the levels: a bladder full of contrast medium, or a part of the colon that
    /// is tagged more. Or they are too uneven, but a level stands on them.
    std::vector<std::int32_t> doubtful;
    BodyFrame frame;
    std::vector<CollapsePath>
        collapses;  ///< of each junction of that kind: its index is the junction's `path`
};

/// What a person said of a scan.
struct GivenPieces {
    std::vector<std::int32_t> colon, notColon;  ///< pieces
    struct Join {
        std::int32_t a, b;  ///< pieces
        glm::dvec3 aMm, bMm;
    };
    std::vector<Join> joins;  ///< the lumen goes on from the one to the other, straight
};

/// Pieces that can be bowel, or are given, and their orifices as junctions. `softTissueMm` are
/// places of the body's soft tissue (softTissueSamples), by which the pieces' own are told;
/// `foldMm` are foldDensityMm of the pieces.
PieceGraph makePieceGraph(const Volume<std::int16_t>& hu, const BowelContents& contents,
                          const TissueModel& tissue, const TubePieces& cut,
                          std::span<const double> foldMm, std::span<const glm::vec3> softTissueMm,
                          const GivenPieces& given, int threads);

}  // namespace haustra::segmentation
