// Where the colon ends: the tips between which its centerline runs.
#pragma once

#include "centerline/search.h"

namespace haustra::centerline {

/// How an end of the lumen looks: any way, blunt or narrowing towards the anus or a collapsed
/// stretch; or the wide blind pouch of the cecum, where nothing narrow belongs to the colon.
enum class EndShape { any, pouch };

/// The tip of the colon farthest from the source of a widest tree.
///
/// The tree's longest path tells where the colon ends, because leaks between loops do not shorten
/// it, but not its very end: it is longest into some deep haustrum, and the terminal ileum or a
/// catheter may lead on. So in the part of the lumen around the path's last few radii, the last
/// wide place counts, by plain geodesic distance (three fifths of the greatest radius there), and
/// the tip is the point of the ball inscribed there that lies straight on. Where the colon goes on
/// narrowing past that place, the tip is the farthest point around its last narrow one (a fifth).
std::int32_t farthestTip(const BlockGraph& graph, const PathTree& widest, EndShape shape);

}  // namespace haustra::centerline
