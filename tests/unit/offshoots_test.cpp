// Opacified bowel that a pool ran into is told from a dull patch of the pool.
#include "topology/offshoots.h"

#include <gtest/gtest.h>

namespace haustra::topology {
namespace {

constexpr double softHu = 40.0, fluidHu = 650.0;

/// Bright fluid for z < 20; from z = 22 a body of its own, joined by a square of `side` voxels.
struct Scene {
    Grid grid = axisAlignedGrid({30, 30, 44}, {1.0, 1.0, 1.0});
    Volume<std::int16_t> hu{grid, std::int16_t(softHu)};

    Scene(int side, int bodyHu) {
        fill(5, 25, 2, 20, int(fluidHu));
        fill(8, 8 + side, 20, 22, bodyHu);
        fill(8, 22, 22, 40, bodyHu);
    }
    void fill(int from, int to, int low, int high, int value) {
        for (int k = low; k < high; ++k)
            for (int j = from; j < to; ++j)
                for (int i = from; i < to; ++i)
                    hu.writable()[grid.index(i, j, k)] = std::int16_t(value);
    }
    std::vector<std::uint32_t> pool() const {
        std::vector<std::uint32_t> voxels;
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            if (hu[n] > 300) voxels.push_back(std::uint32_t(n));
        }
        return voxels;
    }
    std::vector<std::uint32_t> offshoots() const {
        return dullOffshoots(hu, pool(), softHu, fluidHu);
    }
};

TEST(Offshoots, ADullBodyBehindAValveIsOne) {
    const Scene scene(3, 450);
    const auto found = scene.offshoots();
    EXPECT_NEAR(double(found.size()), 14 * 14 * 18, 3 * 3 * 3);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    for (std::uint32_t index : found)
        EXPECT_GE(scene.grid.voxelAt(index).z, 19);
}

TEST(Offshoots, AsBrightABodyIsTheSameFluid) {
    EXPECT_TRUE(Scene(3, 640).offshoots().empty());
}

TEST(Offshoots, ADullPatchInThePoolIsNone) {
    Scene scene(3, 640);
    scene.fill(9, 21, 5, 17, 450);
    EXPECT_TRUE(scene.offshoots().empty());
}

TEST(Offshoots, AThinRimIsNone) {
    Scene scene(3, 640);
    scene.fill(5, 25, 2, 5, 350);
    EXPECT_TRUE(scene.offshoots().empty());
}

TEST(Offshoots, BrightCrumbsInADullBodyGoWithIt) {
    Scene scene(3, 450);
    const std::size_t crumb = scene.grid.index(15, 15, 30);
    scene.hu.writable()[crumb] = 640;
    const auto found = scene.offshoots();
    EXPECT_TRUE(std::binary_search(found.begin(), found.end(), std::uint32_t(crumb)));
}

}  // namespace
}  // namespace haustra::topology
