// The lowest and highest values of a volume's cells, and of ever larger nodes of eight of them
// (dissertation §5.2, after Levoy 1990): what a transfer function leaves empty is known without
// looking at a voxel.
#pragma once

#include "core/volume.h"
#include "render/optics/leap_map.h"
#include "render/optics/transfer_table.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// Shortest and longest side of a leaf, voxels.
inline constexpr int minLeafSide = 1, maxLeafSide = 128;

/// Node k of level l spans the centres of voxels k·side … (k + 1)·side along each axis, where side
/// is leafSide·2^l: level 0 are the leaves, and the last level is one node, the root. The outermost
/// nodes also hold the half voxel between the last centres and the volume's faces. A node's range
/// is that of every voxel which an interpolation inside it reads, so that nodes share the voxels on
/// their faces. Immutable.
class MinMaxOctree {
public:
    /// `leaves` are blockRanges of a grid of so many voxels with a side of leafSide,
    /// minLeafSide…maxLeafSide. O(leaves); holds 5 / leafSide³ bytes a voxel.
    static MinMaxOctree fromLeaves(BlockRanges leaves, int leafSide, glm::ivec3 voxels);

    int leafSide() const { return leafSide_; }
    int levels() const { return int(levels_.size()); }
    glm::ivec3 voxels() const { return voxels_; }
    /// Voxels along the side of a node.
    int sideAt(int level) const { return leafSide_ << level; }
    const BlockRanges& level(int level) const { return levels_[std::size_t(level)]; }
    std::size_t bytes() const;

private:
    int leafSide_ = 1;
    glm::ivec3 voxels_{0};
    std::vector<BlockRanges> levels_;
};

/// What a transfer function makes of a node.
enum class NodeClass : std::uint8_t {
    empty,   ///< no value in it has opacity
    mixed,   ///< some may have
    opaque,  ///< every value has so much that one sample ends a ray (terminationOpacity)
};

/// A ray in voxel coordinates (centres at integers): origin + t · direction.
struct VoxelRay {
    glm::dvec3 origin, direction;
    glm::dvec3 at(double t) const { return origin + t * direction; }
};

/// The part of a ray, enter ≤ t ≤ leave, inside one node.
struct NodeCrossing {
    int level = 0;
    glm::ivec3 node{0};
    double enter = 0.0, leave = 0.0;
};

/// A ray's way from leaf to leaf, or past whole nodes, by three-dimensional DDA: from a node it
/// goes on to one that shares a face with it. Rounding never loses a node: which one is next
/// follows from the face that is crossed.
class OctreeWalk {
public:
    /// Of the part of the ray with from ≤ t ≤ to that is inside the volume's faces.
    OctreeWalk(const VoxelRay& ray, double from, double to, int leafSide, glm::ivec3 voxels);

    bool inside() const { return inside_; }
    glm::ivec3 leaf() const { return leaf_; }
    double t() const { return t_; }  ///< where the ray entered the current leaf
    /// Where the ray leaves the node of this level around the current leaf.
    double leavesAt(int level) const { return exit(level).t; }
    /// Goes on to the first leaf after that node.
    void leave(int level);

private:
    struct Exit {
        double t;
        int axis;
    };
    Exit exit(int level) const;
    VoxelRay ray_;
    double t_ = 0.0, end_ = 0.0;
    int leafSide_;
    glm::ivec3 leaves_, leaf_{0};
    bool inside_ = false;
};

/// An octree's nodes as one transfer function shows them. Immutable.
class ClassifiedOctree {
public:
    /// A node is empty where all its leaves are, and opaque where all are. O(nodes), the same for
    /// any number of threads.
    ClassifiedOctree(const MinMaxOctree& octree, const TransferTable& table, int threads);

    int levels() const { return int(levels_.size()); }
    glm::ivec3 nodes(int level) const { return levels_[std::size_t(level)].size; }
    NodeClass at(int level, glm::ivec3 node) const {
        const Level& nodes = levels_[std::size_t(level)];
        return nodes
            .classes[std::size_t(node.x) +
                     std::size_t(nodes.size.x) *
                         (std::size_t(node.y) + std::size_t(nodes.size.y) * std::size_t(node.z))];
    }

    /// The first node of level `level` along the ray, from ≤ t ≤ to, that is not empty; the ray
    /// skips the largest empty nodes of that level or above. None where all are empty.
    std::optional<NodeCrossing> firstNonEmpty(const VoxelRay& ray, double from, double to,
                                              int level = 0) const;
    /// Calls visit(const NodeCrossing&, NodeClass) for each leaf that the ray pierces, in order,
    /// until it returns false.
    template <class Visit>
    void pierce(const VoxelRay& ray, double from, double to, Visit&& visit) const {
        for (OctreeWalk walk(ray, from, to, leafSide_, voxels_); walk.inside(); walk.leave(0)) {
            const NodeCrossing crossing{0, walk.leaf(), walk.t(), walk.leavesAt(0)};
            if (!visit(crossing, at(0, walk.leaf()))) return;
        }
    }

private:
    struct Level {
        glm::ivec3 size{0};
        std::vector<NodeClass> classes;
    };
    int leafSide_;
    glm::ivec3 voxels_;
    std::vector<Level> levels_;
};

}  // namespace haustra::render
