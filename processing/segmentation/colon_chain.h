// Which pieces of bowel are the colon: the best chain from the rectum to the cecum.
#pragma once

#include "core/colon_record.h"

#include <array>
#include <vector>

namespace haustra::segmentation {

/// A piece of bowel as the search sees it.
struct ChainNode {
    double lengthMm = 0.0;  ///< volume over the inscribed circle's area
    double radiusMm = 0.0;  ///< of the largest ball inside
    double volumeMl = 0.0;
    glm::dvec3 centerMm{0.0};
    glm::dvec3 lowestMm{0.0};  ///< its place farthest towards the feet
    std::array<double, colonParts>
        placeLogOdds{};  ///< of lying where that part does, mean over the piece
    std::array<double, colonParts> foldLogOdds{};  ///< of that part's folds, not the small bowel's
    double rectumLogOdds = 0.0;  ///< of beginning at the anus: its lowest end's place
    double given = 0.0;  ///< what a person said, as log-odds: far above 0 for colon, below for none
};

/// Two pieces that may be joined, and how much speaks for it.
struct ChainJunction {
    int a = 0, b = 0;
    JunctionKind kind = JunctionKind::openLumen;
    double logOdds = 0.0;   ///< ln P(lumen passes) / P(it does not)
    double lengthMm = 0.0;  ///< of a collapse
    double mismatch =
        0.0;  ///< |ln| of the ratio of two fluids' heights over soft tissue that meet in it
    double radiusMm = 0.0, openMm2 = 0.0, wallMm2 = 0.0;
    glm::dvec3 placeMm{0.0};
    int path = -1;  ///< index of the collapse's path, or else of the orifice
};

struct ChainGraph {
    std::vector<ChainNode> nodes;
    std::vector<ChainJunction> junctions;
};

struct ColonChain {
    std::vector<int> nodes;      ///< from the rectum on
    std::vector<int> junctions;  ///< between one node and the next
    std::vector<int> states;     ///< of each node, a ColonPart
    std::vector<int> sacs;  ///< side pieces that belong to the lumen, and the rectum's end (below)
    std::vector<int> rectalEnd;  ///< of the sacs, those taken as such
    std::vector<int> balloons;   ///< of those, what stands between the first piece and others
    std::vector<int> cuts;       ///< open junctions that have to be closed
    double score = 0.0;
};

struct ChainOptions {
    std::size_t labelsPerPlace = 24;
    std::size_t chains = 2;  ///< how many that differ are wanted
};

/// Whether a piece lies where only the rectum's end does: beneath a chain's first piece that comes
/// down to the anus itself, in the middle of the pelvis, no farther off than beyond a balloon (55
/// mm), and wider than a rectal catheter. Loops of small bowel sink no deeper than the pouch of
/// Douglas, 5 to 8 cm over the anus (Standring, Gray's Anatomy, 41st ed., ch. 66).
bool isBelowRectum(const ChainNode& node, const ChainNode& first);

/// The best chains, the best first. Where a catheter's balloon or a fold all but closes the rectum,
/// its end below (isBelowRectum) is too far off for a sac, and too small to begin a chain behind a
/// thin wall: it is one of `sacs` where 10 mm² are open to it, or to what leads down to it, and no
/// wider door, which is closed.
std::vector<ColonChain> findChains(const ChainGraph& graph, const ChainOptions& options = {});

}  // namespace haustra::segmentation
