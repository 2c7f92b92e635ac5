// The bright rim that sharp kernels make around gas, and fluid, which lies beneath it only.
#include "segmentation/edge_overshoot.h"

#include <cmath>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::segmentation;

namespace {

constexpr double gasRadiusMm = 22.0, rimMm = 2.0;
constexpr int rimHu = 320, fluidHu = 500;

struct Scene {
    Volume<std::int16_t> hu;
    Volume<std::uint8_t> content;
    TissueModel tissue;
};

/// Gas over fluid in a ball; `bright`: a rim all around the gas.
Scene ball(bool bright, bool fluid) {
    const Grid grid = axisAlignedGrid({64, 64, 64}, glm::dvec3(1.0));
    Scene scene{Volume<std::int16_t>(grid, std::int16_t(40)),
                Volume<std::uint8_t>(grid, std::uint8_t(Content::tissue)),
                {}};
    scene.tissue.meanHu = {-1000, -100, 40, 500};
    scene.tissue.airBelowHu = -480, scene.tissue.taggedAboveHu = 200;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = glm::dvec3(grid.voxelAt(n)) - glm::dvec3(31.5);
        const double mm = glm::length(p) - gasRadiusMm;
        if (mm < 0.0) {
            const bool below = fluid && p.y > 8.0;
            scene.hu.writable()[n] = below ? fluidHu : -1000;
            scene.content.writable()[n] = std::uint8_t(below ? Content::tagged : Content::gas);
        } else if (bright && mm < rimMm) {
            scene.hu.writable()[n] = rimHu;
            scene.content.writable()[n] = std::uint8_t(Content::tagged);
        }
    }
    return scene;
}

double overshoot(const Scene& scene) {
    return overshootBesideGasHu(scene.hu, scene.content, scene.tissue, 2);
}

TEST(EdgeOvershoot, IsWhatLiesAllAroundGas) {
    EXPECT_GE(overshoot(ball(true, false)), rimHu - 1);
    EXPECT_GE(overshoot(ball(true, true)), rimHu - 1);
}

TEST(EdgeOvershoot, FluidUnderGasIsNone) {
    EXPECT_EQ(overshoot(ball(false, true)), 0.0);
    EXPECT_EQ(overshoot(ball(false, false)), 0.0);
}

TEST(EdgeOvershoot, TheRimIsTakenOffAndTheFluidStays) {
    Scene scene = ball(true, true);
    takeOffOvershoot(scene.hu, rimHu + 1.0, scene.content, 2);
    const Grid& grid = scene.hu.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = glm::dvec3(grid.voxelAt(n)) - glm::dvec3(31.5);
        const bool fluid = scene.hu[n] == fluidHu;
        const bool farFromGas = p.y > 8.0;  // the fluid's own rim stays
        if (fluid || !farFromGas) {
            ASSERT_EQ(Content(scene.content[n]) == Content::tagged, fluid) << p.x << ' ' << p.y;
        }
    }
}

}  // namespace
