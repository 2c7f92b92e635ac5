// Fractions of tissues where they are known: slabs, levels and walls.
#include "cleansing_scenes.h"

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::test;

namespace {

TEST(Mixture, BareInterfaceIsAirAndTaggedNotSoft) {
    const Scene scene = tubeWithLevel(650.0, 10.0);
    const CleansedScene result = cleanseScene(scene);
    const Grid& grid = scene.scan.hu.grid();
    int crossings = 0;
    for (int k = 2; k < grid.size.z - 2; ++k) {
        for (int i = 18; i < 38; ++i) {  // 4.5 mm and more from the wall
            for (int j = 20; j < 36; ++j) {
                const Shares truth =
                    scene.sharesAt(grid.patientFromVoxelPoint(glm::dvec3(i, j, k)));
                const TissueFractions found = result.mixture.at(i, j, k);
                crossings += truth.air > 0.1 && truth.tagged > 0.1;
                EXPECT_LE(found.soft(), 8) << i << ' ' << j << ' ' << k;
                EXPECT_NEAR(found.tagged / 255.0, truth.tagged, 0.06);
            }
        }
    }
    EXPECT_GT(crossings, 300);
}

TEST(Mixture, WallInFluidFollowsItsBlur) {
    const Scene scene = tubeWithLevel(650.0, 5.0);
    const CleansedScene result = cleanseScene(scene);
    const Grid& grid = scene.scan.hu.grid();
    int mixed = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
        const Shares truth = scene.sharesAt(p);
        if (truth.air > 1e-3) continue;
        mixed += truth.tagged > 0.1 && truth.tagged < 0.9;
        EXPECT_NEAR(result.mixture[n].tagged / 255.0, truth.tagged, 0.08);
        EXPECT_LE(result.mixture[n].air, 12);
    }
    EXPECT_GT(mixed, 500);
}

TEST(Mixture, WallBetweenAirAndFluidIsSoft) {
    // Air, 2.4 mm of wall, fluid: side by side, and no level between them.
    const Scene scene = makeScene({60, 40, 20}, 700.0, 12.0, [](glm::dvec3 p) {
        return Shares{blurredStep(18.0 - p.x), blurredStep(p.x - 20.4)};
    });
    const CleansedScene result = cleanseScene(scene);
    const Grid& grid = scene.scan.hu.grid();
    for (int j = 4; j < 36; ++j) {
        const int middle = int(std::lround(19.2 / 0.75));
        EXPECT_GE(result.mixture.at(middle, j, 10).soft(), 220);
        for (int i = 0; i < grid.size.x; ++i)
            EXPECT_NEAR(result.cleansed.hu.at(i, j, 10), scene.untagged.at(i, j, 10), 190) << i;
    }
}

TEST(Mixture, FarFromTheColonEachTissueIsItself) {
    Scene scene = tubeWithLevel(650.0, 10.0);
    const auto hu = scene.scan.hu.writable();
    const Grid& grid = scene.scan.hu.grid();
    const std::size_t fat = grid.index(1, 1, 12), bone = grid.index(54, 54, 12),
                      air = grid.index(1, 54, 12), soft = grid.index(54, 1, 12);
    hu[fat] = -95, hu[bone] = 900, hu[air] = -1000, hu[soft] = 45;
    const CleansedScene result = cleanseScene(scene);
    EXPECT_GE(result.mixture[fat].soft(), 230);
    EXPECT_GE(result.mixture[soft].soft(), 240);
    EXPECT_GE(result.mixture[bone].tagged, 240);
    EXPECT_GE(result.mixture[air].air, 240);
}

TEST(Mixture, SegmentationOnAnotherGridIsRefused) {
    const Scene scene = tubeWithLevel(650.0, 10.0);
    const Volume<std::uint8_t> other(axisAlignedGrid({8, 8, 8}, {1, 1, 1}), std::uint8_t(0));
    const auto mixture = cleansing::estimateMixture(scene.scan, scene.tissue, other, {0, 1, 0});
    ASSERT_FALSE(mixture);
    EXPECT_EQ(mixture.error().kind, ErrorKind::badInput);
}

}  // namespace
