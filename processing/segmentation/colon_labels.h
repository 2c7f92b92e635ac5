// From the colon's chain of pieces to labels: what is lumen, where walls stand, what is crossed.
#pragma once

#include "core/tissue.h"
#include "segmentation/chain_graph.h"
#include "segmentation/enclosed_gas.h"

#include <cstdint>
#include <vector>

namespace haustra::segmentation {

/// A wall between two parts of the lumen, or the lumen and other bowel, too thin for the scan to
/// show whole.
struct RebuiltWall {
    glm::dvec3 placeMm{0.0};
    double areaMm2 = 0.0;
    double radiusMm = 0.0;      ///< of the largest ball that passed
    bool betweenLoops = false;  ///< both sides are the colon's
    bool openedAgain = false;   ///< it parted the colon, and so was no wall
};

/// What is parted from the rest of the colon is more than a crumb of it: a centimetre of colon.
inline constexpr double leastPartedMl = 10.0;

struct LabelOptions {
    double bridgeRadiusMm = 1.5;
    bool asGiven = false;  ///< the contents end where they end: no fit to HU, no stool added
    int threads = 0;
};

struct ColonLabels {
    Volume<std::uint8_t> labels;  ///< LumenLabel; one 6-connected piece
    std::vector<RebuiltWall> walls;
    std::vector<double> bridgeMm;  ///< of each junction of the chain: the length labelled as bridge
    std::vector<EnclosedGas> enclosed;  ///< taken in; not where the contents are given
    double strandedMl = 0.0;            ///< left out since nothing joins it to the rest
};

/// Labels the chain's pieces and sacs, and the small bodies of content that lie open to them.
///
/// Gas is LumenLabel::air; tagged material, and what lies between the two at a level, is
/// LumenLabel::tagged, out to half its local height over soft tissue. A contact between two pieces
/// of the lumen stays open where the ways from the rectum to its two sides are equally long, but
/// for what leads around a neck; elsewhere it leads through a wall between two loops, and that wall
/// is rebuilt, one voxel thick: of each pair of voxels that touch, the one with the HU nearer to
/// soft tissue's is outside. Where that parts 10 ml and more from the rest, it was no wall, and is
/// opened again. So is the wall to other bowel rebuilt. Where the chain crosses a collapse, a
/// bridge of `bridgeRadiusMm` follows its path. Gas within the lumen, behind a wall of its own, is
/// taken in (enclosed_gas.h). The same for any number of threads. O(voxels).
ColonLabels layLabels(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                      const BowelContents& contents, const TubePieces& cut, const PieceGraph& graph,
                      const ColonChain& chain, const LabelOptions& options = {});

}  // namespace haustra::segmentation
