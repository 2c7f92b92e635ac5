// Lumens of content with HU of its own: which bodies are taken, against sets counted by hand.
#include "segmentation/hu_range_lumen.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace haustra::segmentation {
namespace {

const Grid grid = axisAlignedGrid({60, 50, 40}, {1.0, 1.0, 1.5}, {-30.0, 10.0, -100.0});

// 300 HU where `content` holds (of a point in mm from voxel 0), 40 HU elsewhere.
Volume<std::int16_t> scanOf(const std::function<bool(glm::dvec3)>& content) {
    Volume<std::int16_t> hu(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        hu.writable()[n] = content(glm::dvec3(grid.voxelAt(n)) * grid.spacingMm()) ? 300 : 40;
    }
    return hu;
}

bool inBall(glm::dvec3 p, glm::dvec3 center, double radius) {
    return glm::distance(p, center) <= radius;
}
const glm::dvec3 largeCenter(15.0, 25.0, 30.0), smallCenter(45.0, 25.0, 30.0);
bool inLarge(glm::dvec3 p) {
    return inBall(p, largeCenter, 11.0);
}
bool inSmall(glm::dvec3 p) {
    return inBall(p, smallCenter, 7.0);
}
bool inBridge(glm::dvec3 p) {
    return std::hypot(p.y - 25.0, p.z - 30.0) <= 1.6 && p.x > 15.0 && p.x < 45.0;
}
glm::dvec3 patientMm(glm::dvec3 p) {
    return glm::dvec3(-30.0, 10.0, -100.0) + p;
}

HuRangeOptions options() {
    HuRangeOptions options;
    options.contentHu = {200, 500};
    return options;
}

void expectSet(const Result<HuRangeLumen>& found, const Volume<std::int16_t>& of) {
    ASSERT_TRUE(found) << describe(found.error());
    std::size_t wrong = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        wrong += (found->labels[n] != 0) != (of[n] == 300);
    EXPECT_EQ(wrong, 0u);
}

TEST(HuRangeLumen, TheLargestBodyUnlessSeedsSayOtherwise) {
    const auto both = scanOf([](glm::dvec3 p) { return inLarge(p) || inSmall(p); });
    expectSet(findHuRangeLumen(both, options()), scanOf(inLarge));
    HuRangeOptions seeded = options();
    seeded.seedsMm = {patientMm(smallCenter)};
    expectSet(findHuRangeLumen(both, seeded), scanOf(inSmall));
    seeded.seedsMm.push_back(patientMm(largeCenter + glm::dvec3(0, 14.0, 0)));  // 3 mm outside
    expectSet(findHuRangeLumen(both, seeded), both);
    EXPECT_EQ(findHuRangeLumen(both, seeded)->bodies, 2);
    HuRangeOptions excluding = options();
    excluding.excludesMm = {patientMm(largeCenter)};
    expectSet(findHuRangeLumen(both, excluding), scanOf(inSmall));
    excluding.excludesMm.push_back(patientMm(smallCenter));
    EXPECT_EQ(findHuRangeLumen(both, excluding).error().kind, ErrorKind::noResult);
}

TEST(HuRangeLumen, BothEndsOfTheRangeAreContent) {
    auto hu = scanOf(inLarge);
    HuRangeOptions exact = options();
    exact.contentHu = {300, 301};
    expectSet(findHuRangeLumen(hu, exact), hu);
    exact.contentHu = {299, 300};
    expectSet(findHuRangeLumen(hu, exact), hu);
    exact.contentHu = {301, 400};
    EXPECT_EQ(findHuRangeLumen(hu, exact).error().kind, ErrorKind::noResult);
}

TEST(HuRangeLumen, WhatTheContentEnclosesBelongsToIt) {
    const auto hollow =
        scanOf([](glm::dvec3 p) { return inLarge(p) && !inBall(p, largeCenter, 4); });
    const auto found = findHuRangeLumen(hollow, options());
    expectSet(found, scanOf(inLarge));
    EXPECT_EQ(found->notes.size(), 1u);
    // A hole that reaches the outside is none of it.
    const auto bored = scanOf([](glm::dvec3 p) {
        return inLarge(p) && std::hypot(p.x - largeCenter.x, p.y - largeCenter.y) > 3.0;
    });
    expectSet(findHuRangeLumen(bored, options()), bored);
}

TEST(HuRangeLumen, AnOpeningCutsThinBridgesAndNothingElse) {
    const auto bridged =
        scanOf([](glm::dvec3 p) { return inLarge(p) || inSmall(p) || inBridge(p); });
    expectSet(findHuRangeLumen(bridged, options()), bridged);
    HuRangeOptions opening = options();
    opening.openingMm = 3.0;
    const auto found = findHuRangeLumen(bridged, opening);
    ASSERT_TRUE(found) << describe(found.error());
    // By definition: the union of all balls of the radius that fit into the content.
    std::vector<char> expected(grid.voxelCount(), 0);
    const glm::dvec3 spacing = grid.spacingMm();
    const int reach = 4;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        std::vector<std::size_t> ball;
        bool fits = true;
        for (int k = -reach; k <= reach && fits; ++k) {
            for (int j = -reach; j <= reach && fits; ++j) {
                for (int i = -reach; i <= reach && fits; ++i) {
                    const glm::ivec3 at = v + glm::ivec3(i, j, k);
                    if (glm::length(glm::dvec3(i, j, k) * spacing) > opening.openingMm) continue;
                    if (!grid.contains(at)) continue;
                    fits = bridged.at(at) == 300;
                    ball.push_back(grid.index(at));
                }
            }
        }
        for (const std::size_t at : ball)
            expected[at] |= char(fits);
    }
    std::size_t wrong = 0, inside = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = glm::dvec3(grid.voxelAt(n)) * spacing;
        const bool wanted = expected[n] && p.x < 35.0;  // the small ball is another body
        wrong += (found->labels[n] != 0) != wanted;
        inside += wanted;
    }
    EXPECT_GT(inside, 1000u);
    EXPECT_EQ(wrong, 0u);
    opening.openingMm = 20.0;
    EXPECT_EQ(findHuRangeLumen(bridged, opening).error().kind, ErrorKind::noResult);
}

// Noise of sd 100 about 300 HU leaves half of the content's voxels outside ±70.
TEST(HuRangeLumen, SmoothingAndGrowthFindContentUnderNoise) {
    const auto clean = scanOf(inLarge);
    Volume<std::int16_t> noisy = clean.clone();
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 100.0);
    for (std::int16_t& voxel : noisy.writable())
        voxel = std::int16_t(std::lround(voxel + noise(random)));
    HuRangeOptions some;
    some.contentHu = {230, 370};
    const auto wrongShare = [&](const Result<HuRangeLumen>& found) {
        std::size_t wrong = 0, content = 0;
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            wrong += (found->labels[n] != 0) != (clean[n] == 300);
            content += clean[n] == 300;
        }
        return double(wrong) / double(content);
    };
    const auto raw = findHuRangeLumen(noisy, some);
    ASSERT_TRUE(raw);
    const auto smooth = smoothHu(noisy, 1.3, 2);
    auto found = findHuRangeLumen(smooth, some);
    ASSERT_TRUE(found);
    const double before = wrongShare(found);
    EXPECT_LT(before, 0.7 * wrongShare(raw));
    growToWall(found->labels, smooth, 170.0, true, 2);
    EXPECT_LT(wrongShare(found), 0.5 * before);
    EXPECT_LT(wrongShare(found), 0.1);
}

TEST(HuRangeLumen, GrowthGoesThreeVoxelsAndNoFarther) {
    const auto hu = scanOf([](glm::dvec3) { return false; });
    Volume<std::uint8_t> labels(grid, 0);
    labels.writable()[grid.index(30, 25, 20)] = 1;
    growToWall(labels, hu, 41.0, false);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 d = glm::abs(grid.voxelAt(n) - glm::ivec3(30, 25, 20));
        ASSERT_EQ(labels[n] != 0, d.x + d.y + d.z <= 3);
    }
    growToWall(labels, hu, 40.0, false);
    growToWall(labels, hu, 40.0, true);
    EXPECT_EQ(std::ranges::count(labels.voxels(), 1), 63);
}

TEST(HuRangeLumen, APointAwayFromAllContentIsRefused) {
    const auto hu = scanOf(inLarge);
    for (const glm::dvec3 away :
         {patientMm(smallCenter), glm::dvec3(1e5), glm::dvec3(1e300), glm::dvec3(std::nan(""))}) {
        HuRangeOptions seeded = options();
        seeded.seedsMm = {away};
        EXPECT_EQ(findHuRangeLumen(hu, seeded).error().kind, ErrorKind::badInput);
        HuRangeOptions excluding = options();
        excluding.excludesMm = {away};
        EXPECT_EQ(findHuRangeLumen(hu, excluding).error().kind, ErrorKind::badInput);
    }
}

TEST(HuRangeLumen, TheSameForAnyNumberOfThreads) {
    const auto hu = scanOf([](glm::dvec3 p) { return inLarge(p) || inSmall(p) || inBridge(p); });
    HuRangeOptions some = options();
    some.openingMm = 2.0;
    some.threads = 1;
    const auto one = findHuRangeLumen(hu, some).value();
    some.threads = 3;
    const auto three = findHuRangeLumen(hu, some).value();
    EXPECT_TRUE(std::ranges::equal(one.labels.voxels(), three.labels.voxels()));
    EXPECT_TRUE(std::ranges::equal(smoothHu(hu, 1.5, 1).voxels(), smoothHu(hu, 1.5, 3).voxels()));
}

}  // namespace
}  // namespace haustra::segmentation
