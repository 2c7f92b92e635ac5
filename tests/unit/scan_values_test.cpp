// The values within an ellipse, against what is known of them: ramps, balls, single voxels.
#include "core/scan_values.h"

#include "core/slice_placement.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace haustra {
namespace {

using Hu = std::function<double(glm::dvec3)>;

Volume<std::int16_t> sampled(const Grid& grid, const Hu& hu) {
    Volume<std::int16_t> volume(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        volume.writable()[n] =
            std::int16_t(std::lround(hu(grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))))));
    return volume;
}

/// Centred on the origin, its axes turned in the patient.
Grid turnedGrid(glm::ivec3 size, glm::dvec3 spacingMm) {
    Grid grid{size, glm::dmat4(1.0)};
    const glm::dmat4 turned =
        glm::rotate(glm::dmat4(1.0), 0.6, glm::normalize(glm::dvec3(1.0, -2.0, 0.5)));
    grid.patientFromVoxel =
        glm::translate(glm::scale(turned, spacingMm), -0.5 * glm::dvec3(size - 1));
    return grid;
}

TEST(ScanValues, OfALinearRampAreItsOwn) {
    // Over an ellipse a linear function's mean is its value in the middle, its variance a quarter
    // of what it changes along both half axes, squared; so it is for conjugate ones.
    const glm::dvec3 slope(31.0, -17.0, 23.0);
    const Grid grid = turnedGrid({90, 90, 90}, {0.7, 0.8, 1.1});
    const auto scan = sampled(grid, [&](glm::dvec3 p) { return glm::dot(slope, p); });
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    for (int n = 0; n < 60; ++n) {
        const auto vector = [&](double by) {
            return by * glm::dvec3(part(random), part(random), part(random));
        };
        ScanRegion region{vector(6.0), vector(9.0), vector(9.0)};
        if (glm::length(glm::cross(region.halfAMm, region.halfBMm)) < 5.0) continue;
        if (n % 2 == 0) region.slab = {4.0, Projection::mean};
        const auto found = measureScan(scan, region);
        ASSERT_TRUE(found);
        const double a = glm::dot(slope, region.halfAMm), b = glm::dot(slope, region.halfBMm);
        EXPECT_NEAR(found->meanHu, glm::dot(slope, region.centerMm), 0.3);
        EXPECT_NEAR(found->deviationHu, 0.5 * std::hypot(a, b), 0.02 * std::hypot(a, b) + 0.5);
        // The extremes lie on the rim; the outermost cell's middle is a cell within it.
        EXPECT_NEAR(found->greatestHu, found->meanHu + std::hypot(a, b),
                    0.15 * std::hypot(a, b) + 1.0);
        EXPECT_NEAR(found->leastHu, found->meanHu - std::hypot(a, b),
                    0.15 * std::hypot(a, b) + 1.0);
        EXPECT_LE(found->greatestHu, found->meanHu + std::hypot(a, b) + 1.0);
        EXPECT_NEAR(found->areaMm2,
                    std::numbers::pi * glm::length(glm::cross(region.halfAMm, region.halfBMm)),
                    1e-9 * found->areaMm2);
        EXPECT_GE(double(found->samples), 0.7 * 16 * 16);
    }
}

TEST(ScanValues, TheSlabIsThatOfAPicture) {
    // A bright ball beside the plane: a thin region misses it, and what a slab finds is what a
    // slice as thick finds along the line through it.
    const Grid grid = turnedGrid({60, 60, 60}, glm::dvec3(1.0));
    const glm::dvec3 ball(2.0, -3.0, 8.0);
    const auto scan =
        sampled(grid, [&](glm::dvec3 p) { return glm::distance(p, ball) < 3.0 ? 800.0 : -900.0; });
    ScanRegion region{{2.0, -3.0, 0.0}, {6.0, 0.0, 0.0}, {0.0, 6.0, 0.0}};
    EXPECT_EQ(measureScan(scan, region)->greatestHu, -900.0);
    region.slab = {7.0, Projection::maximum};
    EXPECT_EQ(measureScan(scan, region)->greatestHu, -900.0);
    region.slab.thicknessMm = 18.0;
    EXPECT_EQ(measureScan(scan, region)->greatestHu, 800.0);
    EXPECT_EQ(measureScan(scan, region)->leastHu, -900.0);
    // The ball's shadow is a disc of 3 mm in one of 6 mm.
    const auto most = measureScan(scan, region);
    EXPECT_NEAR((most->meanHu + 900.0) / 1700.0, 0.25, 0.05);
    // By the mean, the ball's volume is shared over the whole cylinder.
    region.slab = {24.0, Projection::mean};
    const double share = 4.0 / 3.0 * std::numbers::pi * 27.0 / (std::numbers::pi * 36.0 * 24.0);
    EXPECT_NEAR((measureScan(scan, region)->meanHu + 900.0) / 1700.0, share, 0.15 * share);
}

TEST(ScanValues, APointIsTheVoxelInWhichItLies) {
    std::mt19937 random(8);
    const Grid grid = turnedGrid({12, 9, 7}, {0.7, 0.9, 2.0});
    const auto scan = sampled(grid, [&](glm::dvec3) { return int(random() % 4000) - 1000; });
    std::uniform_real_distribution<double> off(-0.49, 0.49);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 voxel =
            glm::dvec3(grid.voxelAt(n)) + glm::dvec3(off(random), off(random), off(random));
        const auto found =
            measureScan(scan, {.centerMm = grid.patientFromVoxelPoint(voxel), .slab = {5.0}});
        ASSERT_TRUE(found);
        EXPECT_EQ(found->samples, 1u);
        EXPECT_EQ(found->meanHu, scan[n]);
        EXPECT_EQ(found->leastHu, scan[n]);
        EXPECT_EQ(found->greatestHu, scan[n]);
        EXPECT_EQ(found->deviationHu, 0.0);
    }
    for (const glm::dvec3 outside : {glm::dvec3(-0.51, 3, 3), {3, 8.51, 3}, {3, 3, 1e300}}) {
        const auto found = measureScan(scan, {.centerMm = grid.patientFromVoxelPoint(outside)});
        ASSERT_TRUE(found);
        EXPECT_EQ(found->samples, 0u);
    }
}

TEST(ScanValues, WhatLiesOutsideTheScanDoesNotCount) {
    const Grid grid = axisAlignedGrid({40, 40, 40}, glm::dvec3(1.0), glm::dvec3(0.0));
    const Volume<std::int16_t> scan(grid, std::int16_t(77));
    // Half of the disc sticks out of the face at x = −½.
    const ScanRegion half{{-0.5, 20, 20}, {10, 0, 0}, {0, 8, 0}};
    const auto found = measureScan(scan, half);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->meanHu, 77.0);
    EXPECT_EQ(found->deviationHu, 0.0);
    EXPECT_NEAR(found->areaMm2, 0.5 * std::numbers::pi * 80.0, 1e-6);
    const auto outside = measureScan(scan, {{-300, 20, 20}, {10, 0, 0}, {0, 8, 0}});
    ASSERT_TRUE(outside);
    EXPECT_EQ(outside->samples, 0u);
    EXPECT_EQ(outside->areaMm2, 0.0);
}

TEST(ScanValues, WhatIsNoRegionOrTooMuchIsRefused) {
    const Volume<std::int16_t> scan(axisAlignedGrid({64, 64, 64}, glm::dvec3(0.5)),
                                    std::int16_t(0));
    const auto refused = [&](const ScanRegion& region) {
        const auto found = measureScan(scan, region);
        return !found && found.error().kind == ErrorKind::badInput;
    };
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), none(0.0);
    EXPECT_FALSE(refused({none, 10.0 * x, 10.0 * y}));
    EXPECT_TRUE(refused({none, x, none}));
    EXPECT_TRUE(refused({none, none, y}));
    EXPECT_TRUE(refused({none, x, -3.0 * x}));
    EXPECT_TRUE(refused({none, 501.0 * x, y}));
    for (const double bad : {double(NAN), double(INFINITY)}) {
        EXPECT_TRUE(refused({bad * x, x, y}));
        EXPECT_TRUE(refused({none, bad * x, y}));
        EXPECT_TRUE(refused({none, x, bad * y}));
        EXPECT_TRUE(refused({none, x, y, Scan::original, {bad}}));
    }
    EXPECT_TRUE(refused({none, x, y, Scan::original, {-1.0}}));
    EXPECT_TRUE(refused({none, 400.0 * x, 400.0 * y, Scan::original, {50.0}}));
    EXPECT_FALSE(refused({none, 400.0 * x, 400.0 * y}));
}

}  // namespace
}  // namespace haustra
