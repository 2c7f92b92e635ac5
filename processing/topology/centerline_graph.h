// The lumen as a graph of 2×2×2 blocks: the coarse map on which the centerline's route is found.
#pragma once

#include "core/volume.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace haustra::topology {

/// One node for each 2×2×2 block with an inside voxel. Any two voxels of a block touch, and two
/// nodes are joined exactly where voxels of theirs touch, so the graph's connected components are
/// the mask's 26-connected ones: nothing is merged or cut by halving the resolution.
struct BlockGraph {
    struct Node {
        glm::ivec3 voxel;  ///< the block's deepest voxel; the first of several
        float radiusMm;    ///< distance to the boundary there
        std::int32_t component;
        std::uint8_t inside;       ///< bit x + 2y + 4z: that voxel of the block is inside
        std::uint32_t neighbours;  ///< bit n: joined to the node of the n-th of 26 blocks around
    };
    struct Component {
        std::int32_t deepest;  ///< node with the greatest radius; the first of several
        std::size_t voxels;
    };

    Grid grid;
    glm::dvec3 spacingMm{0.0};
    glm::ivec3 blocks{0};              ///< extent of the block grid
    std::vector<std::int32_t> nodeAt;  ///< by block, x fastest; −1: none
    std::vector<Node> nodes;           ///< by block, in memory order
    std::vector<Component> components;
    std::array<std::ptrdiff_t, 26>
        offsets{};  ///< from a block's place in nodeAt to those around it

    std::size_t blockIndex(glm::ivec3 b) const {
        return std::size_t(b.x) + std::size_t(blocks.x) *
                                      (std::size_t(b.y) + std::size_t(blocks.y) * std::size_t(b.z));
    }
    glm::ivec3 voxelOf(std::int32_t node) const { return nodes[std::size_t(node)].voxel; }
    glm::ivec3 blockOf(std::int32_t node) const { return voxelOf(node) / 2; }
    glm::dvec3 positionMm(std::int32_t node) const {
        return grid.patientFromVoxelPoint(voxelOf(node));
    }
    /// Writes the node's neighbours, in a fixed order, and returns how many (at most 26).
    int neighbours(std::int32_t node, std::array<std::int32_t, 26>& found) const;
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

}  // namespace haustra::topology
