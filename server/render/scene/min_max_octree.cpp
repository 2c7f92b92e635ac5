#include "render/scene/min_max_octree.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haustra::render {

namespace {

std::size_t countOf(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

/// Calls body(index of the parent, index of a child) for every child of every node of `parents`.
template <class Body>
void forEachChild(glm::ivec3 parents, glm::ivec3 children, Body&& body) {
    std::size_t child = 0;
    for (int z = 0; z < children.z; ++z)
        for (int y = 0; y < children.y; ++y)
            for (int x = 0; x < children.x; ++x, ++child)
                body(std::size_t(x / 2) +
                         std::size_t(parents.x) *
                             (std::size_t(y / 2) + std::size_t(parents.y) * std::size_t(z / 2)),
                     child);
}

BlockRanges halved(const BlockRanges& leaves) {
    BlockRanges nodes;
    nodes.size = (leaves.size + 1) / 2;
    nodes.lowHu.assign(countOf(nodes.size), std::numeric_limits<std::int16_t>::max());
    nodes.highHu.assign(countOf(nodes.size), std::numeric_limits<std::int16_t>::min());
    forEachChild(nodes.size, leaves.size, [&](std::size_t parent, std::size_t child) {
        nodes.lowHu[parent] = std::min(nodes.lowHu[parent], leaves.lowHu[child]);
        nodes.highHu[parent] = std::max(nodes.highHu[parent], leaves.highHu[child]);
    });
    return nodes;
}

/// Which ranges of values are opaque all through.
class OpaqueRanges {
public:
    explicit OpaqueRanges(const TransferTable& table)
        : firstHu_(table.firstHu),
          perHu_((TransferTable::entries - 1) / (table.lastHu - table.firstHu)),
          clearBefore_(TransferTable::entries + 1, 0) {
        for (std::size_t i = 0; i < TransferTable::entries; ++i) {
            bool clear = false;
            for (std::size_t entry = i; entry < table.rgba.size(); entry += TransferTable::entries)
                clear = clear || double(table.rgba[entry].a) < terminationOpacity;
            clearBefore_[i + 1] = clearBefore_[i] + (clear ? 1 : 0);
        }
    }
    bool contain(double lowHu, double highHu) const {
        const auto entry = [&](double at) {
            return std::size_t(std::clamp(at, 0.0, TransferTable::entries - 1.0));
        };
        return clearBefore_[entry(std::ceil((highHu - firstHu_) * perHu_)) + 1] ==
               clearBefore_[entry(std::floor((lowHu - firstHu_) * perHu_))];
    }

private:
    double firstHu_, perHu_;
    std::vector<int> clearBefore_;
};

}  // namespace

MinMaxOctree MinMaxOctree::fromLeaves(BlockRanges leaves, int leafSide, glm::ivec3 voxels) {
    MinMaxOctree octree;
    octree.leafSide_ = leafSide;
    octree.voxels_ = voxels;
    octree.levels_.push_back(std::move(leaves));
    while (countOf(octree.levels_.back().size) > 1)
        octree.levels_.push_back(halved(octree.levels_.back()));
    return octree;
}

std::size_t MinMaxOctree::bytes() const {
    std::size_t nodes = 0;
    for (const BlockRanges& level : levels_)
        nodes += level.lowHu.size();
    return 2 * sizeof(std::int16_t) * nodes;
}

ClassifiedOctree::ClassifiedOctree(const MinMaxOctree& octree, const TransferTable& table,
                                   int threads)
    : leafSide_(octree.leafSide()),
      voxels_(octree.voxels()),
      levels_(std::size_t(octree.levels())) {
    const OpaqueRanges opaque(table);
    const BlockRanges& leaves = octree.level(0);
    levels_[0] = {leaves.size, std::vector<NodeClass>(leaves.lowHu.size())};
    parallelFor(leaves.lowHu.size(), 1 << 14, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double low = leaves.lowHu[i], high = leaves.highHu[i];
            levels_[0].classes[i] = !table.anyVisible(low, high) ? NodeClass::empty
                                    : opaque.contain(low, high)  ? NodeClass::opaque
                                                                 : NodeClass::mixed;
        }
    });
    for (std::size_t level = 1; level < levels_.size(); ++level) {
        const Level& children = levels_[level - 1];
        Level& nodes = levels_[level];
        nodes.size = octree.level(int(level)).size;
        std::vector<std::uint8_t> seen(countOf(nodes.size));  // a bit for each class among children
        forEachChild(nodes.size, children.size, [&](std::size_t parent, std::size_t child) {
            seen[parent] = std::uint8_t(seen[parent] | 1u << unsigned(children.classes[child]));
        });
        nodes.classes.resize(seen.size());
        for (std::size_t i = 0; i < seen.size(); ++i)
            nodes.classes[i] = seen[i] == 1u << unsigned(NodeClass::empty)    ? NodeClass::empty
                               : seen[i] == 1u << unsigned(NodeClass::opaque) ? NodeClass::opaque
                                                                              : NodeClass::mixed;
    }
}

std::optional<NodeCrossing> ClassifiedOctree::firstNonEmpty(const VoxelRay& ray, double from,
                                                            double to, int level) const {
    OctreeWalk walk(ray, from, to, leafSide_, voxels_);
    while (walk.inside()) {
        int skipped = level;
        while (skipped < levels() && at(skipped, walk.leaf() >> skipped) == NodeClass::empty)
            ++skipped;
        if (skipped == level)
            return NodeCrossing{level, walk.leaf() >> level, walk.t(), walk.leavesAt(level)};
        walk.leave(skipped - 1);
    }
    return std::nullopt;
}

OctreeWalk::OctreeWalk(const VoxelRay& ray, double from, double to, int leafSide, glm::ivec3 voxels)
    : ray_(ray),
      t_(from),
      end_(to),
      leafSide_(leafSide),
      leaves_(glm::max((voxels - 1 + leafSide - 1) / leafSide, glm::ivec3(1))) {
    for (int axis = 0; axis < 3; ++axis) {
        const double low = -0.5 - ray.origin[axis], high = voxels[axis] - 0.5 - ray.origin[axis];
        const double along = ray.direction[axis];
        if (along == 0.0) {
            if (low > 0.0 || high < 0.0) return;
            continue;
        }
        t_ = std::max(t_, std::min(low / along, high / along));
        end_ = std::min(end_, std::max(low / along, high / along));
    }
    if (!(t_ <= end_)) return;
    inside_ = true;
    for (int axis = 0; axis < 3; ++axis) {
        const double at = ray.origin[axis] + t_ * ray.direction[axis];
        leaf_[axis] = int(std::clamp(std::floor(at / leafSide), 0.0, leaves_[axis] - 1.0));
    }
}

OctreeWalk::Exit OctreeWalk::exit(int level) const {
    Exit exit{end_, -1};
    for (int axis = 0; axis < 3; ++axis) {
        const double along = ray_.direction[axis];
        if (along == 0.0) continue;
        const int node = leaf_[axis] >> level, next = along > 0.0 ? node + 1 : node;
        const int face =
            next << level;  // in leaves; beyond the outermost there is the volume's own
        if (face <= 0 || face >= leaves_[axis]) continue;
        const double t = std::max((double(face) * leafSide_ - ray_.origin[axis]) / along, t_);
        if (t < exit.t || (t == exit.t && exit.axis < 0)) exit = {t, axis};
    }
    return exit;
}

void OctreeWalk::leave(int level) {
    const Exit out = exit(level);
    if (out.axis < 0) {
        inside_ = false;
        return;
    }
    t_ = out.t;
    for (int axis = 0; axis < 3; ++axis) {
        const int first = (leaf_[axis] >> level) << level;
        const int last = std::min(first + (1 << level), leaves_[axis]) - 1;
        if (axis == out.axis) {
            leaf_[axis] = ray_.direction[axis] > 0.0 ? last + 1 : first - 1;
        } else {
            const double at = ray_.origin[axis] + t_ * ray_.direction[axis];
            leaf_[axis] = int(std::clamp(std::floor(at / leafSide_), double(first), double(last)));
        }
    }
}

}  // namespace haustra::render
