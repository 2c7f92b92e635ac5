// Flood fill: all that can be reached from some nodes of a graph, step by step.
#pragma once

#include "core/grid.h"

#include <cstddef>
#include <vector>

namespace haustra {

/// Breadth-first search over voxels, cells, triangles, or whatever else has neighbours.
///
/// `front` holds the nodes to start from; all that is reached from them is appended in the order in
/// which it is met. `visitNeighbours(node, visit)` calls visit(neighbour, details…) for each
/// neighbour of a node, with whatever details it knows of the step. `take(neighbour, details…)`
/// says whether the neighbour belongs to what is filled and was not taken before; it must remember
/// what it has taken (the starting nodes too, which are never asked for: mark them before the call
/// or let `take` refuse them). O(steps). Not parallel.
template <class Node, class VisitNeighbours, class Take>
void floodFill(std::vector<Node>& front, const VisitNeighbours& visitNeighbours, const Take& take) {
    for (std::size_t head = 0; head < front.size(); ++head) {
        const Node node = front[head];
        visitNeighbours(node, [&](const auto& next, const auto&... details) {
            if (take(next, details...)) front.push_back(Node(next));
        });
    }
}

/// The voxels that share a face with a voxel of the grid, by index.
inline auto faceNeighbours(const Grid& grid) {
    return [&grid](std::size_t index, const auto& visit) {
        visitFaces(grid, index, [&](std::size_t next, int) { visit(next); });
    };
}

/// The voxels that share a face, an edge or a corner with a voxel of the grid, by index.
inline auto cornerNeighbours(const Grid& grid) {
    return [&grid](std::size_t index, const auto& visit) { visitCorners(grid, index, visit); };
}

}  // namespace haustra
