// The lumen as a graph of 2×2×2 blocks: the coarse map on which the centerline's route is found.
#pragma once

#include "core/volume.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haustra::centerline {

/// One node for each 6-connected body of inside voxels in a 2×2×2 block. Two nodes of blocks that
/// share a face are joined exactly where voxels of theirs do; two of blocks that share an edge or
/// a corner where such joints lead straight from the one to the other. So the graph's connected
/// components are the mask's 6-connected ones: nothing is merged or cut by halving the resolution,
/// and a wall one voxel thick parts what it parts in the mask. Blocks begin at the lower corner of
/// the box around the lumen: a lumen stored by a voxel elsewhere has the same graph there.
struct BlockGraph {
    struct Node {
        glm::ivec3 voxel;  ///< the node's deepest voxel; the first of several
        float radiusMm;    ///< distance to the boundary there
        std::int32_t component;
        std::uint8_t inside;  ///< bit x + 2y + 4z: that voxel of the block is the node's
    };
    struct Component {
        std::int32_t deepest;  ///< node with the greatest radius; the first of several
        std::size_t voxels;
    };

    Grid grid;
    glm::dvec3 spacingMm{0.0};
    glm::ivec3 blocks{0};  ///< extent of the block grid
    /// How many voxels before the grid the first blocks begin: 0 or 1 along each axis.
    glm::ivec3 shift{0};
    /// By block: 1 + its first node; 0: none. Where there is no lumen it takes no memory.
    Volume<std::int32_t> firstNodeOf;
    std::vector<Node> nodes;  ///< by block, in memory order
    std::vector<Component> components;
    std::vector<std::size_t> firstNeighbour;  ///< of each node, in neighbourOf; and the end
    std::vector<std::int32_t> neighbourOf;

    /// The first node of a block; −1: none.
    std::int32_t nodeAt(glm::ivec3 block) const { return firstNodeOf.at(block) - 1; }
    glm::ivec3 voxelOf(std::int32_t node) const { return nodes[std::size_t(node)].voxel; }
    glm::ivec3 blockAt(glm::ivec3 voxel) const { return (voxel + shift) / 2; }
    glm::ivec3 blockOf(std::int32_t node) const { return blockAt(voxelOf(node)); }
    /// The voxel of a block that bit `child` of Node::inside stands for; it may be off the grid.
    glm::ivec3 childVoxel(glm::ivec3 block, int child) const {
        return 2 * block - shift + glm::ivec3(child & 1, child >> 1 & 1, child >> 2);
    }
    int childAt(glm::ivec3 voxel) const {
        const glm::ivec3 odd = (voxel + shift) & 1;
        return odd.x | odd.y << 1 | odd.z << 2;
    }
    glm::dvec3 positionMm(std::int32_t node) const {
        return grid.patientFromVoxelPoint(voxelOf(node));
    }
    std::span<const std::int32_t> neighbours(std::int32_t node) const {
        const std::size_t first = firstNeighbour[std::size_t(node)];
        return {neighbourOf.data() + first, firstNeighbour[std::size_t(node) + 1] - first};
    }
    /// Calls visit(node) for each node of a block.
    template <class Visit>
    void visitNodesOf(glm::ivec3 block, const Visit& visit) const {
        const std::int32_t first = nodeAt(block);
        if (first < 0) return;
        for (std::size_t n = std::size_t(first);
             n < nodes.size() && blockOf(std::int32_t(n)) == block; ++n)
            visit(std::int32_t(n));
    }
    /// The node whose deepest voxel is nearest to a patient point. Needs at least one node; O(n).
    std::int32_t nearest(glm::dvec3 patientMm) const;
};

/// Both volumes on one grid; `distanceMm` is distanceToBoundaryMm(labels).
/// O(voxels). Components are numbered by their first node.
BlockGraph makeBlockGraph(const Volume<std::uint8_t>& labels, const Volume<float>& distanceMm,
                          int threads);

/// Marks the nodes within the balls inscribed along a route, their radii times `part` plus
/// `marginMm`.
void markAlong(const BlockGraph& graph, const std::vector<std::int32_t>& route, double part,
               double marginMm, std::vector<bool>& marked);

}  // namespace haustra::centerline
