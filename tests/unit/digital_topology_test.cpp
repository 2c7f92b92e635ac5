// Masks whose topology is known, and random ones against a count voxel by voxel.
#include "topology/digital_topology.h"

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace haustra::topology {
namespace {

DigitalTopology topologyWhere(glm::ivec3 size, const std::function<bool(glm::ivec3)>& inside) {
    Volume<std::uint8_t> labels(axisAlignedGrid(size, glm::dvec3(1.0)), std::uint8_t(0));
    for (std::size_t n = 0; n < labels.writable().size(); ++n)
        labels.writable()[n] = inside(labels.grid().voxelAt(n)) ? 2 : 0;
    return digitalTopology(labels);
}

void expectTopology(const DigitalTopology& t, long components, long cavities, long handles) {
    EXPECT_EQ(t.components, components);
    EXPECT_EQ(t.cavities, cavities);
    EXPECT_EQ(t.handles(), handles);
    EXPECT_EQ(t.eulerCharacteristic, components - handles + cavities);
    EXPECT_EQ(t.isBall(), components == 1 && cavities == 0 && handles == 0);
}

TEST(DigitalTopology, CountsWhatIsThere) {
    const auto radius = [](glm::ivec3 v) { return glm::length(glm::dvec3(v) - 20.0); };
    expectTopology(topologyWhere({9, 9, 9}, [](auto) { return false; }), 0, 0, 0);
    expectTopology(topologyWhere({9, 8, 7}, [](auto) { return true; }), 1, 0, 0);
    expectTopology(topologyWhere({70, 4, 3}, [](auto v) { return v.x % 3 == 0; }), 24, 0, 0);
    expectTopology(topologyWhere({41, 41, 41}, [&](auto v) { return radius(v) < 15; }), 1, 0, 0);
    expectTopology(
        topologyWhere({41, 41, 41}, [&](auto v) { return radius(v) < 15 && radius(v) > 9; }), 1, 1,
        0);
    expectTopology(topologyWhere({41, 41, 41},
                                 [&](auto v) {
                                     const double ring =
                                         std::hypot(double(v.x) - 20.0, double(v.y) - 20.0);
                                     return std::hypot(ring - 12.0, double(v.z) - 20.0) < 4.0;
                                 }),
                   1, 0, 1);
    // A plate with 3 × 2 holes; a hole at the border counts as well, as all beyond is background.
    expectTopology(
        topologyWhere({130, 20, 5}, [](auto v) { return !(v.x % 40 == 30 && v.y % 10 == 5); }), 1,
        0, 6);
}

TEST(DigitalTopology, FacesJoinTheObjectAndEdgesTheBackground) {
    // Two voxels that share an edge, or a corner, are two; two holes that share an edge are one,
    // and that share a corner are two.
    const auto pair = [](glm::ivec3 other, bool flip) {
        return topologyWhere(
            {6, 6, 6}, [=](glm::ivec3 v) { return (v == glm::ivec3(2) || v == other) != flip; });
    };
    expectTopology(pair({2, 3, 2}, false), 1, 0, 0);
    expectTopology(pair({3, 3, 2}, false), 2, 0, 0);
    expectTopology(pair({3, 3, 3}, false), 2, 0, 0);
    expectTopology(pair({2, 3, 2}, true), 1, 1, 0);
    expectTopology(pair({3, 3, 2}, true), 1, 1, 0);
    expectTopology(pair({3, 3, 3}, true), 1, 2, 0);
}

TEST(DigitalTopology, ACornerBetweenTwoHolesIsOpenForThoseWhoJoinThemThere) {
    // Of two single holes in a block, as of the other generator's scorer, which counts by (6, 26).
    const auto open = [](glm::ivec3 other) {
        Volume<std::uint8_t> block(axisAlignedGrid({6, 6, 6}, glm::dvec3(1.0)), std::uint8_t(1));
        block.writable()[block.grid().index(2, 2, 2)] = 0;
        block.writable()[block.grid().index(other.x, other.y, other.z)] = 0;
        return openCorners(maskOf(block));
    };
    for (const int x : {1, 3}) {
        for (const int y : {1, 3}) {
            for (const int z : {1, 3})
                EXPECT_EQ(open({x, y, z}), 1);
        }
    }
    EXPECT_EQ(open({2, 2, 3}), 0);
    EXPECT_EQ(open({2, 3, 3}), 0);
    EXPECT_EQ(open({4, 4, 4}), 0);
    // From the border inwards, corner by corner: a ball that is none with such corners.
    Volume<std::uint8_t> block(axisAlignedGrid({7, 7, 7}, glm::dvec3(1.0)), std::uint8_t(1));
    EXPECT_TRUE(isBallEitherWay(block));
    block.writable()[block.grid().index(0, 3, 3)] = 0;
    EXPECT_TRUE(isBallEitherWay(block));
    block.writable()[block.grid().index(1, 4, 4)] = 0;
    block.writable()[block.grid().index(1, 5, 4)] = 0;
    block.writable()[block.grid().index(0, 5, 4)] = 0;
    EXPECT_TRUE(digitalTopology(block).isBall());
    EXPECT_FALSE(isBallEitherWay(block)) << "a way through the corner comes out again";
}

/// Components of the voxels where `mask` equals `value`, flooded one voxel at a time.
long componentsByFlooding(const BitMask& mask, bool value, int most, int margin) {
    const glm::ivec3 size = mask.size() + 2 * margin;
    std::vector<char> open(std::size_t(size.x * size.y * size.z));
    const auto place = [&](glm::ivec3 v) {
        return std::size_t(v.x + size.x * (v.y + size.y * v.z));
    };
    const auto voxel = [&](std::size_t n) {
        const int at = int(n);
        return glm::ivec3(at % size.x, at / size.x % size.y, at / size.x / size.y);
    };
    for (std::size_t n = 0; n < open.size(); ++n)
        open[n] = mask.test(voxel(n) - margin) == value;
    long count = 0;
    for (std::size_t n = 0; n < open.size(); ++n) {
        if (!open[n]) continue;
        ++count;
        std::vector<std::size_t> stack{n};
        open[n] = 0;
        while (!stack.empty()) {
            const glm::ivec3 at = voxel(stack.back());
            stack.pop_back();
            for (int d = 0; d < 27; ++d) {
                const glm::ivec3 step(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
                const glm::ivec3 next = at + step;
                if (glm::dot(glm::dvec3(step), glm::dvec3(step)) > most + 0.5 ||
                    glm::any(glm::lessThan(next, glm::ivec3(0))) ||
                    glm::any(glm::greaterThanEqual(next, size)) || !open[place(next)])
                    continue;
                open[place(next)] = 0;
                stack.push_back(place(next));
            }
        }
    }
    return count;
}

TEST(DigitalTopology, AgreesWithFloodingOnRandomMasks) {
    std::mt19937 random(3);
    int withoutOpenCorners = 0;
    for (int trial = 0; trial < 300; ++trial) {
        // Rows of one word, just past one, and past two.
        const std::array<int, 4> widths{7, 62, 63, 130};
        const glm::ivec3 size(widths[random() % 4], 3 + random() % 6, 3 + random() % 6);
        BitMask mask(size);
        const unsigned percent = 2 + random() % 97;
        for (int n = 0; n < size.x * size.y * size.z; ++n) {
            if (random() % 100 < percent)
                mask.set({n % size.x, n / size.x % size.y, n / size.x / size.y});
        }
        const DigitalTopology t = digitalTopology(mask, 1 + trial % 3);
        ASSERT_EQ(t.components, componentsByFlooding(mask, true, 1, 0));
        ASSERT_EQ(t.cavities, componentsByFlooding(mask, false, 2, 1) - 1);
        ASSERT_GE(t.handles(), 0);
        if (openCorners(mask, 1 + trial % 3) > 0) continue;
        ASSERT_EQ(t.cavities, componentsByFlooding(mask, false, 3, 1) - 1);
        ++withoutOpenCorners;
    }
    EXPECT_GT(withoutOpenCorners, 50);
}

}  // namespace
}  // namespace haustra::topology
