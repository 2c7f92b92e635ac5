// The bright rim that sharp kernels make around gas, and fluid, which lies beneath it only.
#include "segmentation/edge_overshoot.h"

#include <cmath>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::segmentation;

namespace {

constexpr double gasRadiusMm = 22.0, rimMm = 2.0;
constexpr int rimHu = 320, fluidTop = 40;  // y of the fluid's first voxel; supine, so y is down

struct Scene {
    Volume<std::int16_t> hu;
    BowelContents contents;
    TissueModel tissue;
};

/// Gas over fluid in a ball; `bright`: a rim all around the gas.
Scene ball(bool bright, bool fluid, int fluidHu = 500) {
    const Grid grid = axisAlignedGrid({64, 64, 64}, glm::dvec3(1.0));
    Scene scene;
    scene.hu = Volume<std::int16_t>(grid, std::int16_t(40));
    scene.contents.content = Volume<std::uint8_t>(grid, std::uint8_t(Content::tissue));
    scene.contents.down = {1, 1};
    scene.tissue.meanHu = {-1000, -100, 40, 500};
    scene.tissue.airBelowHu = -480, scene.tissue.taggedAboveHu = 200;
    Level level;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        const double mm = glm::length(glm::dvec3(v) - glm::dvec3(31.5)) - gasRadiusMm;
        if (mm < 0.0) {
            const bool below = fluid && v.y >= fluidTop;
            if (fluid && v.y == fluidTop) level.columns.push_back({v - glm::ivec3(0, 1, 0), v});
            scene.hu.writable()[n] = std::int16_t(below ? fluidHu : -1000);
            scene.contents.content.writable()[n] =
                std::uint8_t(below ? Content::tagged : Content::gas);
        } else if (bright && mm < rimMm) {
            scene.hu.writable()[n] = rimHu;
            scene.contents.content.writable()[n] = std::uint8_t(Content::tagged);
        }
    }
    if (fluid) scene.contents.levels.push_back(level);
    return scene;
}

double overshoot(const Scene& scene) {
    return overshootBesideGasHu(scene.hu, scene.contents.content, scene.tissue, 2);
}

TEST(EdgeOvershoot, IsWhatLiesAllAroundGas) {
    EXPECT_GE(overshoot(ball(true, false)), rimHu - 1);
    EXPECT_GE(overshoot(ball(true, true)), rimHu - 1);
}

/// A voxel of 1.6 mm beside gas is half gas; the rim is in the next one.
TEST(EdgeOvershoot, IsSeenBehindAWideVoxelsBlur) {
    constexpr double wideMm = 1.6;
    Scene scene;
    const Grid grid = axisAlignedGrid({40, 40, 40}, glm::dvec3(wideMm));
    scene.hu = Volume<std::int16_t>(grid, std::int16_t(40));
    scene.contents.content = Volume<std::uint8_t>(grid, std::uint8_t(Content::tissue));
    scene.tissue.meanHu = {-1000, -100, 40, 500};
    scene.tissue.airBelowHu = -480, scene.tissue.taggedAboveHu = 200;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        // A cube: each side's voxels beside gas are alike.
        const glm::dvec3 away = glm::abs(glm::dvec3(grid.voxelAt(n)) - 19.5);
        const int layer = int(std::ceil(std::max({away.x, away.y, away.z}))) - 12;
        if (layer > 2) continue;
        scene.hu.writable()[n] = std::int16_t(layer <= 0 ? -1000 : layer == 1 ? -300 : rimHu);
        scene.contents.content.writable()[n] = std::uint8_t(layer <= 0   ? Content::gas
                                                            : layer == 1 ? Content::tissue
                                                                         : Content::tagged);
    }
    EXPECT_GE(overshoot(scene), rimHu - 1);
}

TEST(EdgeOvershoot, FluidUnderGasIsNone) {
    for (const bool fluid : {true, false}) {
        Scene scene = ball(false, fluid);
        EXPECT_EQ(overshoot(scene), 0.0);
        takeOffOvershoot(scene.hu, scene.tissue, scene.contents, 2);
        EXPECT_TRUE(scene.contents.warnings.empty());
        const Scene before = ball(false, fluid);
        for (std::size_t n = 0; n < scene.contents.content.voxels().size(); ++n)
            ASSERT_EQ(scene.contents.content[n], before.contents.content[n]);
    }
}

TEST(EdgeOvershoot, TheRimIsTakenOffAndTheFluidStaysEvenWhereItIsDarker) {
    for (const int fluidHu : {500, 260}) {
        Scene scene = ball(true, true, fluidHu);
        takeOffOvershoot(scene.hu, scene.tissue, scene.contents, 2);
        EXPECT_EQ(scene.contents.warnings.size(), 1u);
        const Grid& grid = scene.hu.grid();
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const glm::ivec3 v = grid.voxelAt(n);
            const bool isTagged = Content(scene.contents.content[n]) == Content::tagged;
            if (scene.hu[n] == fluidHu) {
                ASSERT_TRUE(isTagged) << v.x << ' ' << v.y << ' ' << v.z;
            } else if (v.y < fluidTop - 3) {
                ASSERT_FALSE(isTagged) << v.x << ' ' << v.y << ' ' << v.z;
            }
        }
    }
}

}  // namespace
