// Laws of the streaks that starved and hardened rays leave, on bodies of water.
#include "phantom/streaks.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::phantom;

namespace {

/// Slices of an upright elliptic cylinder of water in air, semiaxes a and b mm.
Volume<float> water(double a, double b, int slices, double spacingMm = 2.0, int pixels = 220) {
    const double half = 0.5 * spacingMm * (pixels - 1);
    const Grid grid =
        axisAlignedGrid({pixels, pixels, slices}, {spacingMm, spacingMm, 1.0}, {-half, -half, 0.0});
    Volume<float> hu(grid, -1000.0f);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        if (std::hypot(p.x / a, p.y / b) < 1.0) hu.writable()[n] = 0.0f;
    }
    return hu;
}

/// Mean of u v over the voxels within 30 mm of the axis, v being (di, dj) from u.
double covariance(const Volume<float>& streaks, int di, int dj) {
    double sum = 0.0;
    std::size_t count = 0;
    const Grid& grid = streaks.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        const glm::dvec3 p = grid.patientFromVoxelPoint(v);
        if (std::hypot(p.x, p.y) > 30.0) continue;
        sum += double(streaks[n]) * streaks.at(v.x + di, v.y + dj, v.z), ++count;
    }
    return sum / double(count);
}

TEST(Streaks, HaveTheStatedNoiseWhereEveryRayCrossesTheStatedWater) {
    const Volume<float> hu = water(0.5 * streakWaterMm, 0.5 * streakWaterMm, 12);
    const Volume<float> streaks = streaksOf(hu, 0, 12, 0, {3, 25.0, false}, 0);
    // Rays beside the middle are a little shorter, and pictures a little smoother between pixels.
    EXPECT_NEAR(std::sqrt(covariance(streaks, 0, 0)), 25.0, 3.5);
}

TEST(Streaks, RunAlongTheLongRaysAndAreWeakerInASlimmerBody) {
    const auto made = [](double a, double b) {
        return streaksOf(water(a, b, 16), 0, 16, 0, {4, 20.0, false}, 0);
    };
    const Volume<float> pelvis = made(190.0, 100.0);
    const double variance = covariance(pelvis, 0, 0);
    // What is left of it in means of nine neighbours: from side to side, and from front to back.
    const auto left = [&](int di, int dj) {
        double sum = 0.0;
        for (int n = -8; n <= 8; ++n)
            sum += (9 - std::abs(n)) / 81.0 * covariance(pelvis, n * di, n * dj);
        return sum / variance;
    };
    EXPECT_GT(left(1, 0), 0.2);
    EXPECT_GT(left(1, 0), 8.0 * left(0, 1));
    // The variance is the mean of e^p over the rays through the middle.
    double mean = 0.0;
    for (int a = 0; a < 360; ++a) {
        const double angle = std::numbers::pi * a / 360;
        const double chord = 2.0 / std::hypot(std::cos(angle) / 190.0, std::sin(angle) / 100.0);
        mean += std::exp(waterPerMm * (chord - streakWaterMm)) / 360.0;
    }
    EXPECT_NEAR(std::sqrt(variance), 20.0 * std::sqrt(mean), 0.2 * 20.0 * std::sqrt(mean));
    EXPECT_LT(covariance(made(150.0, 100.0), 0, 0), 0.4 * variance);
}

TEST(Streaks, OfASliceDependOnNoOtherSlabNorOnThreads) {
    const Volume<float> hu = water(150.0, 100.0, 6, 3.0, 128);
    const Volume<float> all = streaksOf(hu, 0, 6, 10, {5, 20.0, false}, 1),
                        some = streaksOf(hu, 2, 3, 12, {5, 20.0, false}, 4);
    const std::size_t slice = std::size_t(128) * 128;
    for (std::size_t n = 0; n < some.grid().voxelCount(); ++n)
        ASSERT_EQ(some[n], all[n + 2 * slice]);
    EXPECT_EQ(some.grid().patientFromVoxelPoint({0, 0, 0}),
              hu.grid().patientFromVoxelPoint({0, 0, 2}));
}

TEST(Streaks, AreNoneWithoutNoiseAndMetal) {
    const Volume<float> streaks = streaksOf(water(150.0, 100.0, 1), 0, 1, 0, {6, 0.0, true}, 0);
    for (const float hu : streaks.voxels())
        ASSERT_EQ(hu, 0.0f);
}

TEST(Streaks, OfTwoRodsOfMetalAreDarkBetweenThem) {
    Volume<float> hu = water(170.0, 100.0, 1, 1.5, 256);
    const Grid grid = hu.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        if (std::hypot(std::abs(p.x) - 60.0, p.y) < 8.0) hu.writable()[n] = 8000.0f;
    }
    const Volume<float> streaks = streaksOf(hu, 0, 1, 0, {7, 0.0, true}, 0);
    const auto mean = [&](glm::dvec2 center, glm::dvec2 half) {
        double sum = 0.0;
        int count = 0;
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const glm::dvec2 p(grid.patientFromVoxelPoint(grid.voxelAt(n)));
            if (std::abs(p.x - center.x) > half.x || std::abs(p.y - center.y) > half.y) continue;
            sum += streaks[n], ++count;
        }
        return sum / count;
    };
    const double between = mean({0, 0}, {30, 5}), below = mean({0, 60}, {30, 5});
    EXPECT_LT(between, -40.0);
    EXPECT_GT(between, -1000.0);
    EXPECT_LT(std::abs(below), 0.3 * std::abs(between));
}

}  // namespace
