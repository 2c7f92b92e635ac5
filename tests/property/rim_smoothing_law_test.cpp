// What smoothing does along the line where air, tagging and wall met, and what it leaves alone.
#include "cleansing/rim_smoothing.h"
#include "cleansing_scenes.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace haustra {
namespace {

using cleansing::smoothRim;
using cleansing::taggedSurroundings;
using test::Shares;

// Air above fluid (the level at y = 15 mm) in a lumen whose wall leans; smooth everywhere.
test::Scene leaningWall() {
    return test::makeScene({48, 40, 24}, 650.0, 0.0, [](glm::dvec3 p) {
        const double open = test::blurredStep(
            glm::dot(p - glm::dvec3(18.0, 15.0, 0.0), glm::dvec3(-0.94, 0.34, 0.0)));
        const double fluid = test::blurredStep(p.y - 15.0);
        return Shares{open * (1.0 - fluid), open * fluid};
    });
}

// A wall 1 mm thin between air above fluid and another loop's air.
test::Scene thinWall() {
    return test::makeScene({56, 40, 24}, 650.0, 0.0, [](glm::dvec3 p) {
        const double pool = test::blurredStep(p.x - 6.0) * test::blurredStep(20.5 - p.x);
        const double other = test::blurredStep(p.x - 21.5) * test::blurredStep(36.0 - p.x);
        const double fluid = test::blurredStep(p.y - 15.0);
        return Shares{other + pool * (1.0 - fluid), pool * fluid};
    });
}

std::vector<std::uint32_t> smooth(const test::Scene& scene, Volume<std::int16_t>& hu, int threads) {
    return smoothRim(hu, scene.labels, scene.tissue, taggedSurroundings(scene.labels, threads),
                     threads);
}

// Flecks of ±500 HU on every third slice of the wall, one voxel about the level.
Volume<std::int16_t> withFlecks(const test::Scene& scene) {
    Volume<std::int16_t> hu = scene.untagged.clone();
    const Grid& grid = hu.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        const bool wall = hu[n] > -900 && hu[n] < 0, level = v.y >= 19 && v.y <= 20;
        if (wall && level && v.z % 3 == 0) hu.writable()[n] += std::int16_t(v.z % 2 ? 500 : -500);
    }
    return hu;
}

double rmsDifference(const Volume<std::int16_t>& a, const Volume<std::int16_t>& b) {
    double sum = 0.0;
    for (std::size_t n = 0; n < a.grid().voxelCount(); ++n)
        sum += double(a[n] - b[n]) * double(a[n] - b[n]);
    return std::sqrt(sum / double(a.grid().voxelCount()));
}

TEST(RimSmoothing, ASmoothWallStaysBitForBit) {
    for (const test::Scene& scene : {leaningWall(), thinWall()}) {
        Volume<std::int16_t> hu = scene.untagged.clone();
        EXPECT_TRUE(smooth(scene, hu, 2).empty());
        EXPECT_EQ(rmsDifference(hu, scene.untagged), 0.0);
    }
}

TEST(RimSmoothing, FlecksGo) {
    const test::Scene scene = leaningWall();
    Volume<std::int16_t> hu = withFlecks(scene);
    const double before = rmsDifference(hu, scene.untagged);
    smooth(scene, hu, 2);
    EXPECT_GT(before, 5.0);
    EXPECT_LT(rmsDifference(hu, scene.untagged), 0.5 * before);
}

TEST(RimSmoothing, AThinWallsCrestIsMadeGood) {
    const test::Scene scene = thinWall();
    Volume<std::int16_t> hu = withFlecks(scene);
    smooth(scene, hu, 2);
    const Grid& grid = hu.grid();
    for (int k = 1; k + 1 < grid.size.z; ++k) {
        for (int j = 16; j < 24; ++j) {
            int most = -1024, truth = -1024;
            for (int i = 26; i < 31; ++i) {
                most = std::max<int>(most, hu.at(i, j, k));
                truth = std::max<int>(truth, scene.untagged.at(i, j, k));
            }
            EXPECT_GT(most, truth - 250) << j << ' ' << k;
        }
    }
}

TEST(RimSmoothing, OnlyTheVoxelsThatItNamesMoveAndTheyLieWhereTheLineWas) {
    const test::Scene scene = leaningWall();
    const Volume<std::int16_t> rough = withFlecks(scene);
    Volume<std::int16_t> one = rough.clone(), two = rough.clone();
    const auto moved = smooth(scene, one, 1);
    EXPECT_EQ(moved, smooth(scene, two, 2));
    EXPECT_EQ(rmsDifference(one, two), 0.0);
    ASSERT_FALSE(moved.empty());
    EXPECT_TRUE(std::is_sorted(moved.begin(), moved.end()));
    for (std::size_t n = 0; n < rough.grid().voxelCount(); ++n) {
        if (std::binary_search(moved.begin(), moved.end(), std::uint32_t(n))) {
            EXPECT_LT(std::abs(rough.grid().voxelAt(n).y - 20), 6);
        } else {
            ASSERT_EQ(one[n], rough[n]);
        }
    }
}

}  // namespace
}  // namespace haustra
