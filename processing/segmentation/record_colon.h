// What was found, as a record: the course, what joins it, what was left out, and what to look at.
#pragma once

#include "core/colon_record.h"
#include "segmentation/bowel_contents.h"
#include "segmentation/chain_graph.h"
#include "segmentation/colon_chain.h"
#include "segmentation/colon_labels.h"
#include "segmentation/metal.h"
#include "segmentation/tube_pieces.h"
#include "segmentation/untagged_levels.h"

#include <optional>
#include <vector>

namespace haustra::segmentation {

/// What the labels were found in.
struct Source {
    /// All of the scan, in the labels' voxels, which may be a box of it; none of a mask alone,
    /// which may be cut off anywhere.
    std::optional<Grid> scanGrid;
    double maskInSoftTissue = 0.0;  ///< ColonRecord::maskInSoftTissue
};

/// Of the first of `chains` (not empty), whose weights by their scores are the confidence among
/// them. `untagged` are the levels whose fluid is not in the lumen, `metal` is metalAtLumen of it.
ColonRecord recordColon(const BowelContents& contents, const TubePieces& cut,
                        const PieceGraph& graph, const std::vector<ColonChain>& chains,
                        const ColonLabels& labels, const std::vector<UntaggedLevel>& untagged,
                        const std::vector<BrightBody>& metal, const Source& source);

}  // namespace haustra::segmentation
