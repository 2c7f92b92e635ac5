#include "phantom/cleansing_score.h"

#include <cmath>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::phantom;

namespace {

const Grid phantomGrid = axisAlignedGrid({48, 48, 40}, {0.8, 0.8, 1.0}, {-5, 3, 60});
constexpr int floorAt = 34, levelAt = 20, ceilingAt = 8;  // along j, which runs down

/// A box of lumen under a flat level: air above, tagging below, wall all around. Beside it lies a
/// polyp of 5³ voxels on the floor, and one that hangs in the air.
Phantom boxPhantom() {
    Phantom phantom;
    phantom.lumen = Volume<std::uint8_t>(phantomGrid, 0);
    phantom.untaggedHu = Volume<std::int16_t>(phantomGrid, 40);
    phantom.scan.hu = Volume<std::int16_t>(phantomGrid, 40);
    const auto labels = phantom.lumen.writable();
    const auto untagged = phantom.untaggedHu.writable(), scan = phantom.scan.hu.writable();
    for (int k = 8; k < 32; ++k) {
        for (int j = ceilingAt; j < floorAt; ++j) {
            for (int i = 8; i < 40; ++i) {
                const std::size_t n = phantomGrid.index(i, j, k);
                labels[n] = j < levelAt ? 1 : 2;
                untagged[n] = -990, scan[n] = j < levelAt ? -990 : 600;
            }
        }
    }
    for (const glm::ivec3 low : {glm::ivec3(20, floorAt - 5, 18), glm::ivec3(20, ceilingAt, 18)}) {
        auto& voxels = phantom.polypVoxels.emplace_back();
        for (int n = 0; n < 125; ++n) {
            const std::size_t at = phantomGrid.index(low + glm::ivec3(n % 5, n / 5 % 5, n / 25));
            labels[at] = 0, untagged[at] = scan[at] = 50;
            voxels.push_back(std::uint32_t(at));
        }
        phantom.polyps.findings.push_back(
            {phantomGrid.patientFromVoxelPoint(low + 2), 4.0, 1.0, "sessile"});
    }
    return phantom;
}

TEST(CleansingScore, TheUntaggedScanIsPerfect) {
    const Phantom truth = boxPhantom();
    const auto score = scoreCleansing(truth, truth.untaggedHu);
    ASSERT_TRUE(score.has_value());
    for (const RegionError* region :
         {&score->fluid, &score->interface, &score->wall, &score->rim}) {
        EXPECT_GT(region->voxels, 100u);
        EXPECT_EQ(region->rmseHu, 0.0);
        EXPECT_EQ(region->biasHu, 0.0);
        EXPECT_EQ(region->maxHu, 0.0);
    }
    EXPECT_EQ(score->voxelsChangedBeyond, 0u);
    ASSERT_EQ(score->polyps.size(), 1u) << "the one in the air is not submerged";
    EXPECT_EQ(score->polyps[0].polyp.positionMm, truth.polyps.findings[0].positionMm);
    EXPECT_EQ(score->polyps[0].submergedShare, 1.0);
    EXPECT_EQ(score->polyps[0].voxels, 125u);
    EXPECT_EQ(score->polyps[0].volumeShare, 1.0);
    EXPECT_EQ(score->polyps[0].excessShare, 0.0);
}

TEST(CleansingScore, EachRegionSeesItsOwnErrorAlone) {
    const Phantom truth = boxPhantom();
    // By the box's coordinates: deep in the fluid, at the level, at a side wall under the fluid.
    struct Expected {
        glm::ivec3 voxel;
        bool fluid, interface, wall, rim;
    };
    for (const Expected& e : {Expected{{12, 26, 12}, true, false, false, false},
                              Expected{{12, levelAt + 1, 12}, false, true, false, false},
                              Expected{{12, levelAt - 2, 12}, false, true, false, false},
                              Expected{{9, 26, 12}, false, false, true, false},
                              Expected{{6, 26, 12}, false, false, true, false},
                              Expected{{9, levelAt, 12}, false, true, true, true},
                              Expected{{5, 26, 12}, false, false, false, false},
                              Expected{{12, levelAt - 3, 12}, false, false, false, false}}) {
        SCOPED_TRACE(testing::Message() << e.voxel.x << " " << e.voxel.y);
        auto cleansed = truth.untaggedHu.clone();
        cleansed.writable()[phantomGrid.index(e.voxel)] += 100;
        const auto score = scoreCleansing(truth, cleansed);
        const auto expect = [&](const RegionError& region, bool in) {
            EXPECT_DOUBLE_EQ(region.biasHu, in ? 100.0 / double(region.voxels) : 0.0);
            EXPECT_DOUBLE_EQ(region.rmseHu, in ? std::sqrt(1e4 / double(region.voxels)) : 0.0);
            EXPECT_EQ(region.maxHu, in ? 100.0 : 0.0);
            if (in) {
                EXPECT_EQ(region.worst.front().voxel, e.voxel);
            }
        };
        expect(score->fluid, e.fluid);
        expect(score->interface, e.interface);
        expect(score->wall, e.wall);
        expect(score->rim, e.rim);
    }
}

TEST(CleansingScore, TheScanItselfFailsByTheTaggingsHeight) {
    const Phantom truth = boxPhantom();
    const auto score = scoreCleansing(truth, truth.scan.hu);
    EXPECT_DOUBLE_EQ(score->fluid.biasHu, 1590.0);
    EXPECT_DOUBLE_EQ(score->fluid.rmseHu, 1590.0);
    EXPECT_EQ(score->voxelsChangedBeyond, 0u);
    EXPECT_EQ(score->polyps[0].volumeShare, 1.0);
    EXPECT_DOUBLE_EQ(score->polyps[0].biasHu, 0.0);
    // The shell of two voxels about the polyp, open on all sides but the floor: 9 · 9 · 7 − 125.
    EXPECT_DOUBLE_EQ(score->polyps[0].excessShare, (9 * 9 * 7 - 125) / 125.0);
}

TEST(CleansingScore, APolypThatIsEatenLosesVolume) {
    const Phantom truth = boxPhantom();
    auto cleansed = truth.untaggedHu.clone();
    for (std::size_t n = 0; n < 50; ++n)
        cleansed.writable()[truth.polypVoxels[0][n]] = -700;
    const auto score = scoreCleansing(truth, cleansed);
    EXPECT_DOUBLE_EQ(score->polyps[0].volumeShare, 75.0 / 125.0);
    EXPECT_DOUBLE_EQ(score->polyps[0].biasHu, -750.0 * 50 / 125);
    EXPECT_DOUBLE_EQ(score->polyps[0].rmseHu, 750.0 * std::sqrt(50.0 / 125));
}

TEST(CleansingScore, ChangesFarFromTheTaggingAreCounted) {
    const Phantom truth = boxPhantom();
    auto cleansed = truth.untaggedHu.clone();
    cleansed.writable()[phantomGrid.index(12, levelAt - 4, 12)] +=
        7;  // four voxels above the fluid
    EXPECT_EQ(scoreCleansing(truth, cleansed)->voxelsChangedBeyond, 0u);
    cleansed.writable()[phantomGrid.index(12, levelAt - 5, 12)] -= 30;
    cleansed.writable()[phantomGrid.index(2, 2, 2)] += 12;
    const auto score = scoreCleansing(truth, cleansed);
    EXPECT_EQ(score->voxelsChangedBeyond, 2u);
    EXPECT_EQ(score->maxChangeBeyondHu, 30.0);
}

TEST(CleansingScore, TheWorstPlaceComesFirst) {
    const Phantom truth = boxPhantom();
    auto cleansed = truth.untaggedHu.clone();
    cleansed.writable()[phantomGrid.index(11, 30, 11)] += 200;
    cleansed.writable()[phantomGrid.index(36, 28, 28)] -= 500;
    const auto score = scoreCleansing(truth, cleansed);
    ASSERT_GE(score->fluid.worst.size(), 2u);
    EXPECT_LE(score->fluid.worst.size(), worstPlaces);
    EXPECT_EQ(score->fluid.worst[0].voxel, glm::ivec3(36, 28, 28));
    EXPECT_LT(score->fluid.worst[0].biasHu, 0.0);
    EXPECT_EQ(score->fluid.worst[1].voxel, glm::ivec3(11, 30, 11));
}

TEST(CleansingScore, RefusesOtherGridsAndPolypsWithoutVoxels) {
    Phantom truth = boxPhantom();
    const Volume<std::int16_t> other(axisAlignedGrid({48, 48, 40}, {0.8, 0.8, 1.1}), 0);
    EXPECT_FALSE(scoreCleansing(truth, other).has_value());
    truth.polypVoxels.pop_back();
    EXPECT_FALSE(scoreCleansing(truth, truth.untaggedHu).has_value());
    truth.polyps.findings.clear(), truth.polypVoxels.clear();
    EXPECT_TRUE(scoreCleansing(truth, truth.untaggedHu).has_value());
    truth.untaggedHu = other.clone();
    EXPECT_FALSE(scoreCleansing(truth, truth.scan.hu).has_value());
}

}  // namespace
