// Tubes with planted handles, islands and gaps: cut where they are thinnest, filled, joined.
#include "topology/handle_cutting.h"

#include "core/simple_point.h"
#include "tube_phantom.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace haustra::topology {
namespace {

using tests::fillTube;
using tests::gridAround;
using tests::sampleCurve;
constexpr double pi = std::numbers::pi;

CutLumen cut(const Volume<std::uint8_t>& labels, int threads = 0) {
    HandleCuttingOptions options;
    options.threads = threads;
    auto result = cutHandles(labels, options);
    EXPECT_TRUE(result) << describe(result.error());
    return result ? std::move(*result) : CutLumen();
}

/// A strut of round section between two points: as thin as `waistMm` at `waistAt` of its length,
/// and wider by `slope` times the distance from there.
struct Strut {
    glm::dvec3 from, to;
    double waistAt, waistMm, slope = 0.35;
    glm::dvec3 axis() const { return glm::normalize(to - from); }
    glm::dvec3 waist() const { return glm::mix(from, to, waistAt); }
};

void fillStrut(Volume<std::uint8_t>& mask, const Strut& strut) {
    for (std::size_t n = 0; n < mask.writable().size(); ++n) {
        const glm::dvec3 d =
            mask.grid().patientFromVoxelPoint(mask.grid().voxelAt(n)) - strut.waist();
        const double along = glm::dot(d, strut.axis());
        if (along < -glm::distance(strut.from, strut.waist()) ||
            along > glm::distance(strut.to, strut.waist()))
            continue;
        if (glm::length(d - along * strut.axis()) <= strut.waistMm + strut.slope * std::abs(along))
            mask.writable()[n] = 1;
    }
}

/// Whether one of the eight corners of a voxel of the mask is open (openCorners).
bool touchesOpenCorner(const BitMask& mask, glm::ivec3 v) {
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 low = v - glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        BitMask eight(glm::ivec3(2));
        for (int n = 0; n < 8; ++n) {
            const glm::ivec3 at(n & 1, n >> 1 & 1, n >> 2);
            if (mask.test(low + at)) eight.set(at);
        }
        if (openCorners(eight) > 0) return true;
    }
    return false;
}

struct Planted {
    glm::dvec3 spacing;
    double turnX, turnZ;  ///< of the whole phantom, radians
};

class PlantedHandles : public testing::TestWithParam<Planted> {};

TEST_P(PlantedHandles, AreCutWithinAVoxelOfTheirThinnestSection) {
    const auto [spacing, turnX, turnZ] = GetParam();
    const auto turned = [=](glm::dvec3 p) {
        p = {p.x, std::cos(turnX) * p.y - std::sin(turnX) * p.z,
             std::sin(turnX) * p.y + std::cos(turnX) * p.z};
        return glm::dvec3(std::cos(turnZ) * p.x - std::sin(turnZ) * p.y,
                          std::sin(turnZ) * p.x + std::cos(turnZ) * p.y, p.z);
    };
    // A long U whose legs three struts join: thin, as wide as a fold's gap, and oblique.
    const auto curve = sampleCurve([&](double t) {
        const double s = 340.0 * t - 170.0, bend = 22.0 * pi / 2.0;
        if (std::abs(s) < bend)
            return turned({22.0 * std::sin(s / 22.0), -22.0 * std::cos(s / 22.0), 0.0});
        return turned({std::copysign(22.0, s), std::abs(s) - bend, 0.0});
    });
    Volume<std::uint8_t> mask(gridAround(curve, 13.0, spacing), std::uint8_t(0));
    fillTube(mask, curve, 9.0);
    const std::vector<Strut> struts{{turned({-18, 20, 0}), turned({18, 20, 0}), 0.5, 1.6},
                                    {turned({-18, 55, 0}), turned({18, 55, 0}), 0.35, 3.0},
                                    {turned({-18, 85, 2}), turned({18, 105, -2}), 0.6, 1.9}};
    for (const Strut& strut : struts)
        fillStrut(mask, strut);
    ASSERT_EQ(digitalTopology(mask).handles(), 3);

    const CutLumen result = cut(mask);
    EXPECT_TRUE(isBallEitherWay(result.labels));
    EXPECT_EQ(result.handlesCut, 3);
    EXPECT_EQ(result.voxelsAdded, 0u);
    const double voxelMm = std::max({spacing.x, spacing.y, spacing.z});
    std::vector<int> removed(struts.size(), 0);
    const BitMask before = maskOf(mask);
    long atCorners = 0;
    for (std::size_t n = 0; n < mask.writable().size(); ++n) {
        if (mask[n] == 0 || result.labels[n] != 0) continue;
        // A step of the tube's own wall that is a handle under the (6, 26) pair.
        if (touchesOpenCorner(before, mask.grid().voxelAt(n))) {
            ++atCorners;
            continue;
        }
        const glm::dvec3 p = mask.grid().patientFromVoxelPoint(mask.grid().voxelAt(n));
        std::size_t nearest = 0;
        for (std::size_t s = 1; s < struts.size(); ++s) {
            if (glm::distance(p, struts[s].waist()) < glm::distance(p, struts[nearest].waist()))
                nearest = s;
        }
        const Strut& strut = struts[nearest];
        // A voxel: its longest side, or its extent along the strut where that is more.
        const double withinMm = std::max(voxelMm, glm::dot(glm::abs(strut.axis()), spacing));
        EXPECT_LE(std::abs(glm::dot(p - strut.waist(), strut.axis())), withinMm + 1e-9)
            << "strut " << nearest;
        EXPECT_LE(glm::distance(p, strut.waist()), strut.waistMm + 1.5 * voxelMm);
        ++removed[nearest];
    }
    EXPECT_LE(atCorners, openCorners(before));
    // A sheet: as many voxels as the section's projection along the grid has, with some to spare
    // for steps.
    const glm::dvec3 faces(spacing.y * spacing.z, spacing.x * spacing.z, spacing.x * spacing.y);
    for (std::size_t s = 0; s < struts.size(); ++s) {
        const glm::dvec3 across = glm::abs(struts[s].axis()) / faces;
        const double section =
            pi * std::pow(struts[s].waistMm + 0.5 * voxelMm, 2) * (across.x + across.y + across.z);
        EXPECT_GT(removed[s], 0);
        EXPECT_LT(removed[s], 1.3 * section + 4.0) << "strut " << s;
    }
}

INSTANTIATE_TEST_SUITE_P(
    SpacingsAndDirections, PlantedHandles,
    testing::Values(Planted{{0.8, 0.8, 0.8}, 0.0, 0.0}, Planted{{0.75, 0.75, 1.0}, 0.5, 0.3},
                    Planted{{0.7, 0.7, 2.0}, 0.0, 0.4}, Planted{{0.75, 0.75, 1.0}, 1.5708, 0.8},
                    Planted{{0.9, 0.6, 1.2}, 1.0, 1.3}, Planted{{0.6, 0.6, 0.6}, 0.7, 2.3},
                    Planted{{0.7, 0.7, 0.7}, 2.2, 0.6}, Planted{{0.75, 0.75, 1.0}, 0.2, 2.9}));

TEST(HandleCutting, LeavesABallAsItIs) {
    const auto curve = sampleCurve(
        [](double t) { return glm::dvec3(40.0 * std::sin(pi * t), 9.0 * t, 99.0 * t); });
    Volume<std::uint8_t> mask(gridAround(curve, 12.0, {0.8, 0.8, 1.0}), std::uint8_t(0));
    fillTube(mask, curve, 8.0);
    fillTube(mask, sampleCurve([&](double t) { return curve[std::size_t(90.0 * t)]; }), 8.0, 2);
    ASSERT_TRUE(digitalTopology(mask).isBall());
    const CutLumen result = cut(mask);
    EXPECT_TRUE(std::ranges::equal(result.labels.voxels(), mask.voxels()));
    EXPECT_EQ(result.handlesCut, 0);
    EXPECT_EQ(result.voxelsRemoved + result.voxelsAdded, 0u);
    EXPECT_TRUE(result.notes.empty());
}

TEST(HandleCutting, KeepsWhatIsOneVoxelThin) {
    // A closed ring of single voxels, a sheet on it, all at an extreme spacing: one voxel is cut.
    for (const glm::dvec3 spacing : {glm::dvec3(1.0), glm::dvec3(0.3, 0.3, 5.0),
                                     glm::dvec3(2.0, 0.1, 0.4), glm::dvec3(10.0)}) {
        Volume<std::uint8_t> mask(axisAlignedGrid({20, 20, 12}, spacing), std::uint8_t(0));
        const auto set = [&](int i, int j, int k) {
            mask.writable()[mask.grid().index(i, j, k)] = 1;
        };
        for (int n = 2; n <= 17; ++n)
            set(n, 2, 5), set(n, 17, 5), set(2, n, 5), set(17, n, 5);
        for (int k = 6; k < 11; ++k) {
            for (int i = 4; i < 9; ++i)
                set(i, 2, k);
        }
        const CutLumen result = cut(mask);
        EXPECT_TRUE(isBallEitherWay(result.labels));
        EXPECT_EQ(result.handlesCut, 1);
        EXPECT_EQ(result.voxelsRemoved, 1u);
    }
}

/// A straight tube along z, and a ball of background that floats in it.
struct TubeWithIsland {
    Volume<std::uint8_t> whole, mask;
    glm::dvec3 middle;

    TubeWithIsland(double tubeMm, glm::dvec3 at, double islandMm) : middle(at) {
        const auto curve = sampleCurve([](double t) { return glm::dvec3(0.0, 0.0, 80.0 * t); });
        mask =
            Volume<std::uint8_t>(gridAround(curve, tubeMm + 4.0, glm::dvec3(1.0)), std::uint8_t(0));
        fillTube(mask, curve, tubeMm);
        whole = mask.clone();
        fillTube(mask, {at}, islandMm, 0);
    }

    std::vector<glm::dvec3> stalk(const CutLumen& cut) const {
        std::vector<glm::dvec3> voxels;
        for (std::size_t n = 0; n < mask.voxels().size(); ++n)
            if (mask[n] != 0 && cut.labels[n] == 0)
                voxels.push_back(mask.grid().patientFromVoxelPoint(mask.grid().voxelAt(n)));
        return voxels;
    }
};

TEST(HandleCutting, TiesAnIslandToTheNearestWallAndSaysSo) {
    TubeWithIsland tube(12.0, {4.0, 1.0, 30.0}, 3.0);
    fillTube(tube.mask, {{-3.0, 2.0, 50.0}}, 0.5, 0);  // a speck
    tube.mask.writable()[tube.mask.grid().index(16, 16, 70)] = 0;
    tube.mask.writable()[tube.mask.grid().index(17, 17, 71)] = 0;  // shares no more than a corner
    const CutLumen result = cut(tube.mask);
    EXPECT_TRUE(isBallEitherWay(result.labels));
    EXPECT_EQ(result.islandsTied, 1);
    EXPECT_EQ(result.cavitiesFilled, 3);
    EXPECT_EQ(result.handlesCut, 0);
    EXPECT_EQ(result.notes.size(), 1u);
    const auto stalk = tube.stalk(result);
    EXPECT_EQ(stalk.size(), result.voxelsRemoved);
    // From its surface to the wall on its own side; by steps along the axes no more than √2 times
    // the straight way, and no farther off than it is deep in the tube.
    EXPECT_GE(stalk.size(), 4u);
    EXPECT_LE(stalk.size(), 8u);
    for (const glm::dvec3 p : stalk) {
        EXPECT_GT(p.x, 0.0);
        EXPECT_NEAR(p.z, 30.0, 4.0);
    }
    // The island is wall, as is all that was.
    for (std::size_t n = 0; n < tube.whole.voxels().size(); ++n) {
        const glm::dvec3 p = tube.mask.grid().patientFromVoxelPoint(tube.mask.grid().voxelAt(n));
        if (tube.whole[n] == 0 || glm::distance(p, tube.middle) < 2.5) {
            EXPECT_EQ(result.labels[n], 0);
        }
    }
    const CutLumen alone = cut(tube.mask, 1);
    EXPECT_TRUE(std::ranges::equal(alone.labels.voxels(), result.labels.voxels()));
}

TEST(HandleCutting, LaysAStalkWhereTheScanShowsItsTrace) {
    const TubeWithIsland tube(12.0, {4.0, 0.0, 30.0}, 3.0);
    // The trace leads away from the nearest wall: half tissue, half gas.
    Volume<std::int16_t> hu(tube.mask.grid(), std::int16_t(-1000));
    for (std::size_t n = 0; n < hu.voxels().size(); ++n) {
        const glm::dvec3 p = hu.grid().patientFromVoxelPoint(hu.grid().voxelAt(n));
        if (tube.mask[n] == 0) hu.writable()[n] = 40;
        if (p.x < 3.0 && std::abs(p.y) < 0.6 && std::abs(p.z - 30.0) < 0.6 && tube.mask[n] != 0)
            hu.writable()[n] = -700;
    }
    HandleCuttingOptions options;
    options.hu = &hu;
    const auto result = cutHandles(tube.mask, options);
    ASSERT_TRUE(result) << describe(result.error());
    EXPECT_TRUE(isBallEitherWay(result->labels));
    EXPECT_EQ(result->islandsTied, 1);
    const auto stalk = tube.stalk(*result);
    EXPECT_GE(stalk.size(), 11u);
    for (const glm::dvec3 p : stalk) {
        EXPECT_LT(p.x, 3.0);
        EXPECT_LT(std::abs(p.y) + std::abs(p.z - 30.0), 1.2);
    }
    options.hu = nullptr;
    for (const glm::dvec3 p : tube.stalk(*cutHandles(tube.mask, options)))
        EXPECT_GT(p.x, 3.0);
    const Volume<std::int16_t> elsewhere(axisAlignedGrid({4, 4, 4}, glm::dvec3(1.0)));
    options.hu = &elsewhere;
    EXPECT_FALSE(cutHandles(tube.mask, options));
}

TEST(HandleCutting, FillsAnIslandThatNoWallIsNear) {
    const TubeWithIsland tube(32.0, {0.0, 0.0, 40.0}, 3.0);
    const CutLumen result = cut(tube.mask);
    EXPECT_EQ(result.islandsTied, 0);
    EXPECT_EQ(result.cavitiesFilled, 1);
    EXPECT_EQ(result.notes.size(), 1u);
    EXPECT_EQ(result.voxelsRemoved, 0u);
    EXPECT_TRUE(std::ranges::equal(result.labels.voxels(), tube.whole.voxels()));
}

TEST(HandleCutting, JoinsPiecesAndLeavesCrumbsOut) {
    const auto arch = [](double t) {
        return glm::dvec3(-60.0 * std::cos(pi * t), 0.0, 60.0 * std::sin(pi * t));
    };
    const auto whole = sampleCurve(arch);
    Volume<std::uint8_t> mask(gridAround(whole, 12.0, {0.8, 0.8, 1.0}), std::uint8_t(0));
    fillTube(mask, sampleCurve([&](double t) { return arch(0.35 * t); }), 8.0);
    fillTube(mask, sampleCurve([&](double t) { return arch(0.5 + 0.1 * t); }), 8.0, 2);
    fillTube(mask, sampleCurve([&](double t) { return arch(0.75 + 0.25 * t); }), 8.0);
    Volume<std::uint8_t> tubes = mask.clone();
    mask.writable()[0] = 1;
    ASSERT_EQ(digitalTopology(mask).components, 4);
    const CutLumen result = cut(mask);
    EXPECT_TRUE(isBallEitherWay(result.labels));
    EXPECT_EQ(result.notes.size(), 3u);  // the crumb and two bridges
    EXPECT_EQ(result.voxelsRemoved, 1u);
    std::size_t bridge = 0;
    for (std::size_t n = 0; n < tubes.writable().size(); ++n) {
        if (tubes[n] != 0) {
            EXPECT_EQ(result.labels[n], tubes[n]);
        } else if (result.labels[n] != 0) {
            EXPECT_EQ(result.labels[n], std::uint8_t(LumenLabel::bridge));
            ++bridge;
            const glm::dvec3 p = mask.grid().patientFromVoxelPoint(mask.grid().voxelAt(n));
            EXPECT_LT(tests::distanceToCurve(whole, p), 8.0 + 1.5);
        }
    }
    EXPECT_EQ(bridge, result.voxelsAdded);
    EXPECT_GT(bridge, 50u);
}

TEST(HandleCutting, CutsTheLeakAndNotTheBridgeAcrossACollapse) {
    // An arch that is collapsed at its top, crossed by a thin bridge; its legs touch over a hole
    // that is wider. Without the bridge's label the hole is the colon's way.
    const auto arch = [](double t) {
        return glm::dvec3(-30.0 * std::cos(pi * t), 0.0, 60.0 * std::sin(pi * t));
    };
    const auto whole = sampleCurve(arch);
    const auto gap = sampleCurve([&](double t) { return arch(0.4 + 0.2 * t); });
    for (const bool labelled : {true, false}) {
        Volume<std::uint8_t> mask(gridAround(whole, 12.0, {0.8, 0.8, 1.0}), std::uint8_t(0));
        fillTube(mask, gap, 1.5, std::uint8_t(labelled ? LumenLabel::bridge : LumenLabel::air));
        fillTube(mask, sampleCurve([&](double t) { return arch(0.4 * t); }), 8.0);
        fillTube(mask, sampleCurve([&](double t) { return arch(0.6 + 0.4 * t); }), 8.0);
        fillStrut(mask, {{-26, 0, 15}, {26, 0, 15}, 0.5, 3.0, 0.1});
        ASSERT_EQ(digitalTopology(mask).handles(), 1);
        const CutLumen result = cut(mask);
        EXPECT_TRUE(isBallEitherWay(result.labels));
        std::size_t leakCut = 0, bridgeCut = 0;
        for (std::size_t n = 0; n < mask.voxels().size(); ++n) {
            if (mask[n] == 0 || result.labels[n] != 0) continue;
            const glm::dvec3 p = mask.grid().patientFromVoxelPoint(mask.grid().voxelAt(n));
            (p.z < 40.0 ? leakCut : bridgeCut) += 1;
        }
        EXPECT_EQ(leakCut > 0, labelled);
        EXPECT_EQ(bridgeCut > 0, !labelled);
    }
}

TEST(HandleCutting, MakesABallOfAnything) {
    // Noise, thresholded at all levels: handles and cavities by the hundred. In the end no voxel
    // of the body that was left out could be added, but for stalks.
    std::mt19937 random(5);
    int withoutStalks = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const unsigned percent = 30 + unsigned(trial) * 69 / 40;
        Volume<std::uint8_t> mask(axisAlignedGrid({30, 25, 20}, {0.7, 0.7, 1.0 + 0.1 * trial}));
        for (std::uint8_t& label : mask.writable())
            label = random() % 100 < percent ? 1 + random() % 2 : 0;
        const CutLumen result = cut(mask);
        ASSERT_TRUE(isBallEitherWay(result.labels)) << percent;
        const BitMask ball = maskOf(result.labels);
        std::size_t removed = 0, added = 0;
        for (std::size_t n = 0; n < mask.writable().size(); ++n) {
            const glm::ivec3 v = mask.grid().voxelAt(n);
            removed += mask[n] != 0 && result.labels[n] == 0;
            added += mask[n] == 0 && result.labels[n] != 0;
            if (mask[n] == 0) continue;
            if (result.labels[n] != 0) {
                EXPECT_EQ(result.labels[n], mask[n]);
            } else if (result.islandsTied == 0) {
                EXPECT_FALSE(isSimpleEitherWay(ball.around(v)));
            }
        }
        withoutStalks += result.islandsTied == 0;
        EXPECT_EQ(result.voxelsRemoved, removed);
        EXPECT_EQ(result.voxelsAdded, added);
    }
    EXPECT_GE(withoutStalks, 20);
}

TEST(HandleCutting, IsTheSameForAnyNumberOfThreads) {
    std::mt19937 random(6);
    Volume<std::uint8_t> mask(axisAlignedGrid({70, 64, 50}, {0.7, 0.7, 1.0}));
    for (std::size_t n = 0; n < mask.writable().size(); ++n) {
        const glm::dvec3 v(mask.grid().voxelAt(n));
        mask.writable()[n] =
            std::sin(0.3 * v.x) + std::sin(0.25 * v.y) + std::sin(0.4 * v.z) > 0.1 ||
            random() % 5 == 0;
    }
    const CutLumen one = cut(mask, 1), two = cut(mask, 2), many = cut(mask, 5);
    EXPECT_TRUE(std::ranges::equal(one.labels.voxels(), two.labels.voxels()));
    EXPECT_TRUE(std::ranges::equal(one.labels.voxels(), many.labels.voxels()));
    EXPECT_EQ(one.notes, many.notes);
}

TEST(HandleCutting, RefusesAnEmptyLumen) {
    const auto none = cutHandles(
        Volume<std::uint8_t>(axisAlignedGrid({9, 9, 9}, glm::dvec3(1.0)), std::uint8_t(0)));
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::noResult);
    Volume<std::uint8_t> full(axisAlignedGrid({9, 9, 9}, glm::dvec3(1.0)), std::uint8_t(1));
    EXPECT_TRUE(isBallEitherWay(cut(full).labels));
}

}  // namespace
}  // namespace haustra::topology
