// Minimum-cost paths through the lumen that keep away from its boundary.
#pragma once

#include "centerline/graph.h"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace haustra::centerline {

/// Paths from one or several sources to the nodes of a graph.
struct PathTree {
    std::vector<std::int32_t> parent;  ///< towards the source; −1 at a source and where not reached
    std::vector<float> lengthMm;  ///< of the tree's path from the source; −1 where not reached
    std::vector<std::int32_t> order;  ///< of a widest tree: what is reached, parents first
};

/// The tree of widest paths from one node through its component: of all ways to a node, the tree's
/// narrowest place is the widest. So each handle of the lumen is cut at its narrowest place, which
/// is the leak where two loops touch and not the colon, however long the way around.
/// The minimum-cost spanning tree of Wan et al. (IEEE TMI 21:1450, 2002; dissertation §1.2.1
/// [126]), by Prim's algorithm: the deepest node on the frontier is next, the first of equals.
/// O(n log n).
PathTree growWidestTree(const BlockGraph& graph, std::int32_t source);

/// The same widest tree seen from another of its nodes: the widest way between any two nodes is the
/// tree's, so one tree serves all. Linear.
PathTree rerooted(PathTree widest, std::int32_t source);

/// What a step costs: its length, or its length over the distance from the boundary.
enum class StepCost { length, closeness };

/// Dijkstra from several sources at once, no farther than `longestMm` and, where `within` is not
/// empty, over the nodes that it holds. O(n log n).
PathTree growCheapestTree(const BlockGraph& graph, std::span<const std::int32_t> sources,
                          StepCost cost, const std::vector<bool>& within = {},
                          double longestMm = std::numeric_limits<double>::infinity());

/// The node with the longest path; the first of several.
std::int32_t longestPathEnd(const PathTree& tree);

/// From the tree's source to `target`.
std::vector<std::int32_t> pathTo(const PathTree& tree, std::int32_t target);

/// The path that minimises ∫ ds / distance from the boundary, from the route's first node to its
/// last, within the inner part of the balls inscribed along the route, where no leak leads out of
/// the colon. Unlike the tree's path it does not swing into every haustrum.
std::vector<std::int32_t> centerRoute(const BlockGraph& graph,
                                      const std::vector<std::int32_t>& route);

/// The exact minimum of the same cost over single voxels, from the deepest voxel of
/// the route's first block to that of its last, within `reach` blocks of the
/// route. A step goes to one of 26 voxels where voxels lead there face by face.
std::vector<glm::ivec3> refineToVoxels(const BlockGraph& graph, const Volume<float>& distanceMm,
                                       const std::vector<std::int32_t>& route, int reach = 3);

}  // namespace haustra::centerline
