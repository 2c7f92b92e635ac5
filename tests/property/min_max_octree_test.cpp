// The min-max octree against its definition, and rays through it against plain stepping.
#include "render/scene/min_max_octree.h"

#include "random_volume.h"

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace haustra::render {
namespace {

using tests::randomVolume;

/// Opaque from `fromHu` on, clear a HU below.
TransferTable stepTable(double fromHu, double stepMm = 0.5) {
    TransferFunction step;
    step.points = {{-1000.0, glm::dvec3(1.0), 0.0},
                   {fromHu - 1.0, glm::dvec3(1.0), 0.0},
                   {fromHu, glm::dvec3(1.0), 1.0},
                   {fromHu + 100.0, glm::dvec3(1.0), 1.0}};
    return makeTransferTable({step}, stepMm);
}

MinMaxOctree octreeOf(const Volume<std::int16_t>& volume, int leafSide, int threads) {
    return MinMaxOctree::fromLeaves(blockRanges(volume, leafSide, threads), leafSide,
                                    volume.grid().size);
}

const glm::ivec3 sizes[] = {{33, 20, 17}, {1, 1, 1}, {2, 9, 70}, {64, 65, 66}, {129, 3, 5}};

TEST(MinMaxOctree, NodesHoldTheRangeOfWhatInterpolationsInsideRead) {
    for (const glm::ivec3 size : sizes) {
        const Volume<std::int16_t> volume = randomVolume(size, 3, 0.2);
        for (const int leafSide : {1, 2, 5, 16, 128}) {
            const MinMaxOctree octree = octreeOf(volume, leafSide, 2);
            const glm::ivec3 root = octree.level(octree.levels() - 1).size;
            EXPECT_EQ(root, glm::ivec3(1));
            for (int level = 0; level < octree.levels(); ++level) {
                const BlockRanges& nodes = octree.level(level);
                const int side = octree.sideAt(level);
                EXPECT_TRUE(glm::all(glm::greaterThanEqual(nodes.size * side, size - 1)));
                std::size_t at = 0;
                for (int z = 0; z < nodes.size.z; ++z)
                    for (int y = 0; y < nodes.size.y; ++y)
                        for (int x = 0; x < nodes.size.x; ++x, ++at) {
                            const glm::ivec3 from = glm::ivec3(x, y, z) * side;
                            const glm::ivec3 to = glm::min(from + side, size - 1);
                            int low = 32767, high = -32768;
                            for (int k = from.z; k <= to.z; ++k)
                                for (int j = from.y; j <= to.y; ++j)
                                    for (int i = from.x; i <= to.x; ++i) {
                                        low = std::min<int>(low, volume.at(i, j, k));
                                        high = std::max<int>(high, volume.at(i, j, k));
                                    }
                            ASSERT_EQ(nodes.lowHu[at], low);
                            ASSERT_EQ(nodes.highHu[at], high);
                        }
            }
        }
    }
}

TEST(MinMaxOctree, IsTheSameForAnyNumberOfThreads) {
    const Volume<std::int16_t> volume = randomVolume({90, 77, 53}, 5, 0.1);
    const MinMaxOctree one = octreeOf(volume, blockSide, 1), four = octreeOf(volume, blockSide, 4);
    for (int level = 0; level < one.levels(); ++level) {
        EXPECT_EQ(one.level(level).lowHu, four.level(level).lowHu);
        EXPECT_EQ(one.level(level).highHu, four.level(level).highHu);
    }
}

TEST(ClassifiedOctree, SaysWhatItsLeavesShow) {
    const Volume<std::int16_t> volume = randomVolume({61, 58, 47}, 7, 0.9);
    const MinMaxOctree octree = octreeOf(volume, 2, 2);
    const TransferTable tables[] = {stepTable(90.0), stepTable(-2000.0), stepTable(5.0),
                                    stepTable(-900.0)};
    for (const TransferTable& table : tables) {
        const ClassifiedOctree classified(octree, table, 3);
        for (int level = 0; level < octree.levels(); ++level) {
            const glm::ivec3 nodes = classified.nodes(level), leaves = classified.nodes(0);
            for (int z = 0; z < nodes.z; ++z)
                for (int y = 0; y < nodes.y; ++y)
                    for (int x = 0; x < nodes.x; ++x) {
                        const glm::ivec3 from = glm::ivec3(x, y, z) << level;
                        const glm::ivec3 to = glm::min(from + (1 << level), leaves);
                        bool allEmpty = true, allOpaque = true;
                        for (int k = from.z; k < to.z; ++k)
                            for (int j = from.y; j < to.y; ++j)
                                for (int i = from.x; i < to.x; ++i) {
                                    const std::size_t leaf =
                                        std::size_t(i + leaves.x * (j + leaves.y * k));
                                    const int low = octree.level(0).lowHu[leaf];
                                    const int high = octree.level(0).highHu[leaf];
                                    allEmpty = allEmpty && !table.anyVisible(low, high);
                                    allOpaque = allOpaque && low >= table.lastHu - 100.0;
                                }
                        const NodeClass is = classified.at(level, {x, y, z});
                        ASSERT_EQ(is == NodeClass::empty, allEmpty);
                        // Errs to mixed within an entry of the step.
                        if (is == NodeClass::opaque) {
                            ASSERT_TRUE(allOpaque);
                        }
                    }
        }
    }
    // Where all values lie well above the step, everything is opaque.
    EXPECT_EQ(ClassifiedOctree(octree, stepTable(-2000.0), 1).at(octree.levels() - 1, {}),
              NodeClass::opaque);
}

struct RandomRays {
    std::mt19937 random{11};
    VoxelRay next(glm::ivec3 size) {
        std::uniform_real_distribution<double> place(-0.5, 1.5), way(-1.0, 1.0);
        std::uniform_int_distribution<int> kind(0, 5);
        VoxelRay ray;
        for (int axis = 0; axis < 3; ++axis) {
            ray.origin[axis] = place(random) * size[axis];
            ray.direction[axis] = way(random);
            if (kind(random) == 0) ray.direction[axis] = 0.0;
            if (kind(random) == 0) ray.origin[axis] = std::round(ray.origin[axis]);
        }
        if (ray.direction == glm::dvec3(0.0)) ray.direction.y = -1.0;
        return ray;
    }
};

using Leaf = std::tuple<int, int, int>;
Leaf leafAt(glm::dvec3 p, int side, glm::ivec3 leaves) {
    const glm::ivec3 leaf =
        glm::clamp(glm::ivec3(glm::floor(p / double(side))), glm::ivec3(0), leaves - 1);
    return {leaf.x, leaf.y, leaf.z};
}

TEST(ClassifiedOctree, RaysPierceEveryLeafTheyPassInOrder) {
    for (const glm::ivec3 size : {glm::ivec3(61, 58, 47), {1, 30, 9}, {40, 2, 2}}) {
        const Volume<std::int16_t> volume = randomVolume(size, 13, 0.05);
        const MinMaxOctree octree = octreeOf(volume, 4, 2);
        const ClassifiedOctree classified(octree, stepTable(50.0), 2);
        RandomRays rays;
        for (int repeat = 0; repeat < 400; ++repeat) {
            const VoxelRay ray = rays.next(size);
            std::set<Leaf> pierced;
            double last = 0.0;
            glm::ivec3 before(-1);
            classified.pierce(ray, 0.0, 1000.0, [&](const NodeCrossing& at, NodeClass is) {
                EXPECT_EQ(is, classified.at(0, at.node));
                EXPECT_LE(at.enter, at.leave);
                EXPECT_GE(at.enter, last - 1e-9);
                if (before.x >= 0) {
                    const glm::ivec3 apart = glm::abs(at.node - before);
                    EXPECT_EQ(apart.x + apart.y + apart.z, 1) << "not by a face";
                    EXPECT_NEAR(at.enter, last, 1e-9);
                }
                before = at.node;
                last = at.leave;
                pierced.insert({at.node.x, at.node.y, at.node.z});
                return true;
            });
            // Points well inside a leaf lie in one that was pierced.
            for (double t = 0.0; t < 200.0; t += 0.037) {
                const glm::dvec3 p = ray.at(t);
                const bool in = glm::all(glm::greaterThan(p, glm::dvec3(-0.5))) &&
                                glm::all(glm::lessThan(p, glm::dvec3(size) - 0.5));
                const glm::dvec3 frac = glm::fract(p / 4.0);
                const bool nearFace = glm::any(glm::lessThan(frac, glm::dvec3(1e-6))) ||
                                      glm::any(glm::greaterThan(frac, glm::dvec3(1.0 - 1e-6)));
                if (in && !nearFace) {
                    ASSERT_TRUE(pierced.contains(leafAt(p, 4, classified.nodes(0))));
                }
            }
        }
    }
}

TEST(ClassifiedOctree, TheFirstNonEmptyNodeIsWhatWalkingLeafByLeafFinds) {
    const glm::ivec3 size(61, 58, 47);
    const Volume<std::int16_t> volume = randomVolume(size, 17, 0.0005);
    const MinMaxOctree octree = octreeOf(volume, 2, 2);
    const ClassifiedOctree classified(octree, stepTable(5.0), 2);
    RandomRays rays;
    int found = 0;
    for (int repeat = 0; repeat < 600; ++repeat) {
        const VoxelRay ray = rays.next(size);
        for (int level = 0; level < classified.levels(); ++level) {
            std::optional<NodeCrossing> expected;
            classified.pierce(ray, 1.0, 300.0, [&](const NodeCrossing& at, NodeClass) {
                if (classified.at(level, at.node >> level) == NodeClass::empty) return true;
                expected = NodeCrossing{level, at.node >> level, at.enter, 0.0};
                return false;
            });
            const auto first = classified.firstNonEmpty(ray, 1.0, 300.0, level);
            ASSERT_EQ(first.has_value(), expected.has_value());
            if (!first) continue;
            ++found;
            EXPECT_EQ(first->node, expected->node);
            EXPECT_NEAR(first->enter, expected->enter, 1e-9);
            EXPECT_LE(first->enter, first->leave);
            EXPECT_NE(classified.at(level, first->node), NodeClass::empty);
        }
    }
    EXPECT_GT(found, 500);
}

}  // namespace
}  // namespace haustra::render
