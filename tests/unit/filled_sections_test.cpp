// A section of colon full of fluid is found through its opening, and through nothing else.
#include "topology/filled_sections.h"

#include <gtest/gtest.h>

namespace haustra::topology {
namespace {

constexpr std::int16_t softHu = 40, fluidHu = 600;
constexpr int wallVoxels = 2;

TissueModel tissueModel() {
    TissueModel tissue;
    tissue.meanHu = {-980.0, -100.0, softHu, fluidHu};
    tissue.airBelowHu = -470.0;
    tissue.taggedAboveHu = 320.0;
    return tissue;
}

/// A found pool for z < 12 and, beyond a partition of two voxels at z = 12, a body of fluid.
struct Scene {
    Grid grid = axisAlignedGrid({30, 30, 40}, {1.0, 1.0, 1.0});
    Volume<std::int16_t> hu{grid, softHu};
    Volume<std::uint8_t> labels{grid, std::uint8_t(0)};

    Scene() {
        fill(2, 12, [](int, int) { return fluidHu; });
        for (std::size_t n = 0; n < grid.voxelCount(); ++n)
            labels.writable()[n] =
                std::uint8_t(hu[n] > 320 ? LumenLabel::tagged : LumenLabel::outside);
        fill(12 + wallVoxels, 36, [](int, int) { return fluidHu; });
    }
    template <class Hu>
    void fill(int from, int to, Hu&& value) {
        for (int k = from; k < to; ++k)
            for (int j = 6; j < 24; ++j)
                for (int i = 6; i < 24; ++i)
                    hu.writable()[grid.index(i, j, k)] = std::int16_t(value(i, j));
    }
    /// Fluid in the partition, over a square of this many voxels a side.
    void open(int side) {
        fill(12, 12 + wallVoxels, [&](int i, int j) {
            return i < 8 + side && j < 8 + side && i >= 8 && j >= 8 ? fluidHu : softHu;
        });
    }
    double find(std::vector<std::uint32_t> excluded = {}) {
        return addFilledSections(labels, hu, tissueModel(), excluded);
    }
    bool taken() const { return labels.at(15, 15, 25) == std::uint8_t(LumenLabel::tagged); }
};

TEST(FilledSections, ABroadOpeningLetsThemIn) {
    Scene scene;
    scene.open(12);
    EXPECT_NEAR(scene.find(), 18 * 18 * 22 / 1000.0, 0.6);
    EXPECT_TRUE(scene.taken());
    EXPECT_EQ(scene.labels.at(15, 15, 13), std::uint8_t(LumenLabel::tagged))
        << "the opening itself";
    EXPECT_EQ(scene.labels.at(3, 15, 25), std::uint8_t(LumenLabel::outside)) << "the wall";
}

TEST(FilledSections, AWallOrAValveKeepsThemOut) {
    Scene walled, valve;
    EXPECT_EQ(walled.find(), 0.0);
    valve.open(5);
    EXPECT_EQ(valve.find(), 0.0);
    EXPECT_FALSE(valve.taken());
}

TEST(FilledSections, BoneIsNotFluid) {
    Scene scene;
    scene.open(12);
    scene.fill(12 + wallVoxels, 36, [](int i, int j) {
        const bool rind = i < 9 || j < 9 || i >= 21 || j >= 21;
        return rind ? 1400 : 550;
    });
    EXPECT_EQ(scene.find(), 0.0);
}

TEST(FilledSections, WhatIsExcludedStaysOut) {
    Scene scene;
    scene.open(12);
    std::vector<std::uint32_t> excluded;
    for (std::size_t n = 0; n < scene.grid.voxelCount(); ++n) {
        if (scene.labels[n] == 0 && scene.hu[n] == fluidHu) excluded.push_back(std::uint32_t(n));
    }
    EXPECT_EQ(scene.find(excluded), 0.0);
}

TEST(FilledSections, NothingHappensWhereNothingIsTagged) {
    Scene scene;
    scene.open(12);
    std::fill(scene.labels.writable().begin(), scene.labels.writable().end(), std::uint8_t(0));
    EXPECT_EQ(scene.find(), 0.0);
}

}  // namespace
}  // namespace haustra::topology
