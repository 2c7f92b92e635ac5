// Minimum-cost paths through the lumen that keep away from its boundary.
#pragma once

#include "topology/centerline_graph.h"

#include <cstdint>
#include <vector>

namespace haustra::topology {

/// What a way through the lumen costs, per mm, where the boundary is `radiusMm` away: a power of
/// its inverse (Wan et al., IEEE TMI 21:1450, 2002; dissertation §1.2.1 [126]). The route through
/// the colon is found with a steep cost, for which a narrow leak between two touching loops is
/// dearer than the long way through an open colon; the line within the route with a gentle one,
/// which does not swing into every haustrum.
double costPerMm(double radiusMm, int exponent);
inline constexpr int routeExponent = 3, lineExponent = 1;

/// The minimum-cost tree of one component.
struct PathTree {
    std::vector<std::int32_t>
        parent;                   ///< towards the source; −1 at the source and where not reached
    std::vector<float> lengthMm;  ///< of the tree's path from the source; −1 where not reached
};

/// Dijkstra with the route's cost from `source` over the graph's nodes; of paths of equal cost the
/// one that comes first in the order of nodes. O(n log n).
PathTree growPathTree(const BlockGraph& graph, std::int32_t source);

/// How an end of the lumen looks: an open colon that narrows towards the anus or a collapsed
/// stretch, or the wide blind pouch of the cecum.
enum class EndShape { narrowing, pouch };

/// The tip of the colon farthest from the tree's source. The longest path of the tree finds the end
/// of the colon, because leaks between loops do not shorten it. Over the last few radii plain
/// geodesic distance decides, because a path that keeps to the ridge is longest into any deep
/// haustrum, and only a place of about the colon's width there counts (two fifths of it; in a
/// pouch, four fifths), because the terminal ileum or a catheter may lead on. The tip is the
/// farthest point around that place.
std::int32_t farthestTip(const BlockGraph& graph, const PathTree& tree, EndShape shape);

/// From the tree's source to `target`.
std::vector<std::int32_t> pathTo(const PathTree& tree, std::int32_t target);

/// The minimum-cost path, with the line's cost, from the route's first node to its last within the
/// inner part of the balls inscribed along the route, where no leak leads out of the colon.
std::vector<std::int32_t> centreRoute(const BlockGraph& graph,
                                      const std::vector<std::int32_t>& route);

/// The exact minimum-cost path, with the line's cost, over single voxels (26-connected), from the
/// deepest voxel of the route's first block to that of its last, within `reach` blocks of the
/// route.
std::vector<glm::ivec3> refineToVoxels(const BlockGraph& graph, const Volume<float>& distanceMm,
                                       const std::vector<std::int32_t>& route, int reach = 3);

}  // namespace haustra::topology
