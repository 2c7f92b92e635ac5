// Where the colon ends: the tips between which its centerline runs.
#pragma once

#include "topology/centerline_search.h"

namespace haustra::topology {

/// How an end of the lumen looks: an open colon that narrows towards the anus or a collapsed
/// stretch, or the wide blind pouch of the cecum.
enum class EndShape { narrowing, pouch };

/// The tip of the colon farthest from the source of a widest tree.
///
/// The tree's longest path tells where the colon ends, because leaks between loops do not shorten
/// it, but not its very end: it is longest into some deep haustrum, and the terminal ileum or a
/// catheter may lead on. So in the part of the lumen around the path's last few radii, the last
/// place wide enough counts, by plain geodesic distance: a fifth of the greatest radius there
/// where the colon narrows, four fifths in a pouch. The tip is the farthest point near that place
/// or, in a pouch, the point of the ball inscribed there that lies straight on.
std::int32_t farthestTip(const BlockGraph& graph, const PathTree& widest, EndShape shape);

}  // namespace haustra::topology
