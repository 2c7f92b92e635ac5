// Side branches of a lumen: what leads off the main route, as in a tree of vessels.
#pragma once

#include "centerline/search.h"

#include <cstdint>
#include <vector>

namespace haustra::centerline {

/// The routes that lead at least `shortestMm` out of the balls inscribed along the main route and
/// along the branches before, the longest first; each from a node of one of those to its tip.
/// `widest` is the widest tree that holds `mainRoute`. Every node farther off than that lies near
/// a branch. O(n log n) in the graph's nodes.
std::vector<std::vector<std::int32_t>> sideBranches(const BlockGraph& graph, const PathTree& widest,
                                                    const std::vector<std::int32_t>& mainRoute,
                                                    double shortestMm);

}  // namespace haustra::centerline
