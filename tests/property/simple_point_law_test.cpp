// Topological numbers against components counted by the definition's letter, voxel by voxel.
#include "core/simple_point.h"
#include "topology/digital_topology.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace haustra::topology {
namespace {

struct Offset {
    int x, y, z;
};
Offset offsetOf(int n) {
    return {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
}
/// Who is an n-neighbour of whom, or the same (n = 6, 18 or 26).
struct Adjacency {
    std::array<std::array<bool, 27>, 27> holds{};
    explicit Adjacency(int n) {
        for (int v = 0; v < 27; ++v) {
            for (int w = 0; w < 27; ++w) {
                const Offset a = offsetOf(v), b = offsetOf(w);
                const int dx = std::abs(a.x - b.x), dy = std::abs(a.y - b.y),
                          dz = std::abs(a.z - b.z);
                const int most = n == 6 ? 1 : n == 18 ? 2 : 3;
                holds[std::size_t(v)][std::size_t(w)] =
                    std::max({dx, dy, dz}) <= 1 && dx + dy + dz <= most;
            }
        }
    }
    bool operator()(int v, int w) const { return holds[std::size_t(v)][std::size_t(w)]; }
};

/// #Cₙ[Nₙᵏ(x, X)] for the set X that `inSet` marks, straight from Bertrand's definitions.
int topologicalNumberByDefinition(const std::array<bool, 27>& inSet, const Adjacency& adjacent,
                                  int k) {
    std::vector<int> geodesic;
    for (int v = 0; v < 27; ++v) {
        if (v != 13 && inSet[std::size_t(v)] && adjacent(v, 13)) geodesic.push_back(v);
    }
    for (int order = 2; order <= k; ++order) {
        std::vector<int> wider;
        for (int v = 0; v < 27; ++v) {
            if (v == 13 || !inSet[std::size_t(v)]) continue;
            if (std::any_of(geodesic.begin(), geodesic.end(),
                            [&](int y) { return adjacent(v, y); }))
                wider.push_back(v);
        }
        geodesic = wider;
    }
    int components = 0;
    std::array<bool, 27> seen{};
    for (int start : geodesic) {
        if (seen[std::size_t(start)]) continue;
        ++components;
        std::vector<int> stack{start};
        seen[std::size_t(start)] = true;
        while (!stack.empty()) {
            const int v = stack.back();
            stack.pop_back();
            for (int w : geodesic) {
                if (seen[std::size_t(w)] || !adjacent(v, w)) continue;
                seen[std::size_t(w)] = true;
                stack.push_back(w);
            }
        }
    }
    return components;
}

void expectAgrees(Neighbourhood object) {
    static const Adjacency sixAdjacency(6), eighteenAdjacency(18), twentySixAdjacency(26);
    std::array<bool, 27> inside, outside;
    for (int v = 0; v < 27; ++v) {
        inside[std::size_t(v)] = object >> v & 1u;
        outside[std::size_t(v)] = !inside[std::size_t(v)];
    }
    const int t6 = topologicalNumberByDefinition(inside, sixAdjacency, 3);
    const int t18 = topologicalNumberByDefinition(outside, eighteenAdjacency, 2);
    ASSERT_EQ(topologicalNumber6(object), t6) << std::hex << object;
    ASSERT_EQ(topologicalNumber18(object), t18) << std::hex << object;
    ASSERT_EQ(isSimple(object), t6 == 1 && t18 == 1) << std::hex << object;
    const int t6Of26 = topologicalNumberByDefinition(inside, sixAdjacency, 2);
    const int t26 = topologicalNumberByDefinition(outside, twentySixAdjacency, 1);
    ASSERT_EQ(topologicalNumber6Of26(object), t6Of26) << std::hex << object;
    ASSERT_EQ(topologicalNumber26(object), t26) << std::hex << object;
    ASSERT_EQ(isSimpleEitherWay(object), t6 == 1 && t18 == 1 && t6Of26 == 1 && t26 == 1)
        << std::hex << object;
}

/// The bits of `number` put where `mask` has ones.
Neighbourhood deposited(unsigned number, Neighbourhood mask) {
    Neighbourhood result = 0;
    for (; mask; mask &= mask - 1, number >>= 1) {
        if (number & 1u) result |= mask & (~mask + 1u);
    }
    return result;
}

TEST(SimplePoint, AgreesWithTheDefinitionOnTwoMillionRandomNeighbourhoods) {
    std::mt19937 random(7);
    constexpr int densities = 20, each = 100'000;
    for (int density = 0; density <= densities; ++density) {
        for (int n = 0; n < each; ++n) {
            Neighbourhood object = 0;
            for (int v = 0; v < 27; ++v) {
                if (int(random() % densities) < density) object |= 1u << v;
            }
            expectAgrees(object);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(SimplePoint, AgreesWithTheDefinitionOnAllSubsetsOfTheEighteen) {
    // All 2¹⁸ sets of faces and edges, with no corner, with all and with four.
    Neighbourhood eighteen = 0, corners = 0;
    for (int v = 0; v < 27; ++v) {
        const Offset o = offsetOf(v);
        const int sum = std::abs(o.x) + std::abs(o.y) + std::abs(o.z);
        if (sum == 1 || sum == 2) eighteen |= 1u << v;
        if (sum == 3) corners |= 1u << v;
    }
    for (Neighbourhood more : {Neighbourhood(0), corners, corners & 0x070001c0u}) {
        for (unsigned number = 0; number < 1u << 18; ++number) {
            expectAgrees(deposited(number, eighteen) | more);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(SimplePoint, TheVoxelItselfDoesNotCount) {
    std::mt19937 random(9);
    for (int n = 0; n < 10'000; ++n) {
        const Neighbourhood object = random() & random() & ((1u << 27) - 1u);
        EXPECT_EQ(isSimple(object | 1u << 13), isSimple(object & ~(1u << 13)));
    }
}

/// By how much the Euler characteristic grows where a voxel is added: by 1 less that of what it is
/// attached to, a part of a sphere with `object` components that leaves `background` of it.
long eulerGrowth(int object, int background) {
    const long attached = object == 0 ? 0 : background == 0 ? 2 : 1 + object - background;
    return 1 - attached;
}

TEST(SimplePoint, AddingOneChangesNoTopologyAndAddingAnyOtherDoes) {
    // Random sets in a small grid: components, cavities and Euler characteristic, counted over the
    // whole grid, change exactly where the voxel is not simple.
    std::mt19937 random(11);
    long simple = 0, either = 0, other = 0;
    for (int trial = 0; trial < 20'000; ++trial) {
        BitMask mask(glm::ivec3(5));
        const unsigned percent = 5 + random() % 90;
        for (int n = 0; n < 125; ++n) {
            if (random() % 100 < percent) mask.set({n % 5, n / 5 % 5, n / 25});
        }
        const glm::ivec3 v(random() % 5, random() % 5, random() % 5);
        mask.reset(v);
        const DigitalTopology before = digitalTopology(mask, 1);
        const long openBefore = openCorners(mask, 1);
        const Neighbourhood around = mask.around(v);
        mask.set(v);
        const DigitalTopology after = digitalTopology(mask, 1);
        const long openAfter = openCorners(mask, 1);
        if (isSimple(around)) {
            ASSERT_EQ(before, after);
        }
        if (isSimpleEitherWay(around)) {
            ASSERT_TRUE(isSimple(around));
            ASSERT_EQ(openBefore, openAfter);
        }
        const long growth = after.eulerCharacteristic - before.eulerCharacteristic;
        ASSERT_EQ(growth, eulerGrowth(topologicalNumber6(around), topologicalNumber18(around)));
        // Under the (6, 26) pair χ is less by the open corners.
        ASSERT_EQ(growth - (openAfter - openBefore),
                  eulerGrowth(topologicalNumber6Of26(around), topologicalNumber26(around)));
        (isSimple(around) ? simple : other) += 1;
        either += isSimpleEitherWay(around);
    }
    EXPECT_GT(either, 1000);
    EXPECT_GT(simple, either);
    EXPECT_GT(other, 1000);
}

TEST(SimplePoint, EveryAcceptedAdditionLeavesABallABall) {
    // Grown voxel by voxel in random order, inside noise, until nothing is simple: under the
    // (6, 18) pair, which leaves open corners, and either way, which leaves none.
    std::mt19937 random(13);
    long added = 0, open = 0;
    for (int trial = 0; trial < 120; ++trial) {
        constexpr int side = 9;
        const bool eitherWay = trial % 2 == 1;
        const auto accepted = eitherWay ? isSimpleEitherWay : isSimple;
        const unsigned percent = 50 + random() % 51;
        BitMask ball{glm::ivec3(side)};
        std::vector<glm::ivec3> candidates;
        for (int n = 0; n < side * side * side; ++n) {
            const glm::ivec3 v(n % side, n / side % side, n / side / side);
            if (random() % 100 < percent) candidates.push_back(v);
        }
        ball.set(candidates.front());
        for (bool any = true; any;) {
            any = false;
            std::shuffle(candidates.begin(), candidates.end(), random);
            for (const glm::ivec3 v : candidates) {
                if (ball.test(v) || !accepted(ball.around(v))) continue;
                ball.set(v);
                any = true;
                ++added;
                ASSERT_TRUE(digitalTopology(ball, 1).isBall());
                if (eitherWay) {
                    ASSERT_EQ(openCorners(ball, 1), 0);
                }
            }
        }
        open += openCorners(ball, 1);
    }
    EXPECT_GT(added, 20'000);
    EXPECT_GT(open, 0);
}

}  // namespace
}  // namespace haustra::topology
