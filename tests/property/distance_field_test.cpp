// The distance field against its definition.
#include "topology/distance_field.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace haustra::topology {
namespace {

/// The definition: every inside voxel against every outside voxel.
std::vector<double> bruteForce(const Volume<std::uint8_t>& labels) {
    const Grid& grid = labels.grid();
    const glm::dvec3 spacing = grid.spacingMm();
    std::vector<double> distance(grid.voxelCount(), 0.0);
    for (std::size_t a = 0; a < distance.size(); ++a) {
        if (labels[a] == 0) continue;
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t b = 0; b < distance.size(); ++b) {
            if (labels[b] != 0) continue;
            const glm::dvec3 d = spacing * glm::dvec3(grid.voxelAt(a) - grid.voxelAt(b));
            best = std::min(best, glm::dot(d, d));
        }
        distance[a] = std::sqrt(best);
    }
    return distance;
}

/// Noise, or boxes cut out of a full volume, or a few outside voxels: unlike shapes, unlike runs.
Volume<std::uint8_t> randomMask(std::mt19937& random) {
    const auto upTo = [&](int n) { return int(random() % unsigned(n)); };
    const auto spacing = [&] { return 0.3 + 0.01 * upTo(300); };
    const Grid grid = axisAlignedGrid({1 + upTo(24), 1 + upTo(20), 1 + upTo(18)},
                                      {spacing(), spacing(), spacing()}, {-17.0, 4.0, 1000.0});
    Volume<std::uint8_t> mask(grid);
    const int kind = upTo(3);
    const double inside = kind == 0 ? 0.05 + 0.9 * upTo(100) / 100.0 : kind == 1 ? 0.995 : 1.0;
    for (auto& voxel : mask.writable()) {
        voxel = std::uniform_real_distribution(0.0, 1.0)(random) < inside
                    ? std::uint8_t(1 + upTo(2))
                    : 0;
    }
    for (int box = 0; kind == 2 && box < 1 + upTo(3); ++box) {
        const glm::ivec3 lo(upTo(grid.size.x), upTo(grid.size.y), upTo(grid.size.z));
        const glm::ivec3 hi =
            glm::min(lo + glm::ivec3(1 + upTo(8), 1 + upTo(8), 1 + upTo(8)), grid.size);
        for (int k = lo.z; k < hi.z; ++k) {
            for (int j = lo.y; j < hi.y; ++j) {
                for (int i = lo.x; i < hi.x; ++i)
                    mask.writable()[grid.index(i, j, k)] = 0;
            }
        }
    }
    return mask;
}

TEST(DistanceField, AgreesWithBruteForceOnRandomAnisotropicVolumes) {
    std::mt19937 random(20261);
    for (int trial = 0; trial < 120; ++trial) {
        const Volume<std::uint8_t> mask = randomMask(random);
        const Volume<float> distance = distanceToBoundaryMm(mask, 1 + trial % 3);
        const std::vector<double> truth = bruteForce(mask);
        ASSERT_TRUE(sameGrid(distance.grid(), mask.grid()));
        for (std::size_t v = 0; v < truth.size(); ++v) {
            if (std::isinf(truth[v])) {
                ASSERT_TRUE(std::isinf(distance[v]));
            } else {
                // A float's rounding, twice: of the squares between the axes, and of the result.
                ASSERT_NEAR(distance[v], truth[v], 1.5e-7 * truth[v])
                    << "trial " << trial << ", voxel " << v;
            }
        }
    }
}

TEST(DistanceField, IsTheSameForAnyNumberOfThreads) {
    std::mt19937 random(7);
    const Grid grid = axisAlignedGrid({70, 61, 53}, {0.7, 0.9, 1.25});
    Volume<std::uint8_t> mask(grid);
    for (auto& voxel : mask.writable())
        voxel = random() % 50 != 0;
    const Volume<float> one = distanceToBoundaryMm(mask, 1);
    for (const int threads : {2, 3, 8, 0}) {
        const Volume<float> many = distanceToBoundaryMm(mask, threads);
        EXPECT_EQ(std::memcmp(one.voxels().data(), many.voxels().data(), one.sizeBytes()), 0)
            << threads;
    }
}

TEST(DistanceField, OfABallIsItsRadiusLessTheDistanceFromTheCentre) {
    const Grid grid = axisAlignedGrid({60, 80, 40}, {1.0, 0.75, 1.5});
    const glm::dvec3 center(29.5, 29.6, 29.2);
    const double radius = 24.0;
    Volume<std::uint8_t> mask(grid);
    for (std::size_t v = 0; v < grid.voxelCount(); ++v) {
        mask.writable()[v] =
            glm::distance(grid.patientFromVoxelPoint(grid.voxelAt(v)), center) < radius;
    }
    const Volume<float> distance = distanceToBoundaryMm(mask);
    const double diagonal = glm::length(grid.spacingMm());
    for (std::size_t v = 0; v < grid.voxelCount(); ++v) {
        if (!mask[v]) continue;
        const double depth =
            radius - glm::distance(grid.patientFromVoxelPoint(grid.voxelAt(v)), center);
        ASSERT_GE(distance[v], depth);
        ASSERT_LE(distance[v], depth + diagonal);
    }
}

TEST(DistanceField, DoesNotSeeVoxelsBeyondTheGrid) {
    const Volume<std::uint8_t> full(axisAlignedGrid({5, 4, 3}, glm::dvec3(1.0)), std::uint8_t(2));
    const Volume<float> distance = distanceToBoundaryMm(full);
    for (const float d : distance.voxels())
        EXPECT_TRUE(std::isinf(d));
    const Volume<std::uint8_t> none(axisAlignedGrid({5, 4, 3}, glm::dvec3(1.0)), std::uint8_t(0));
    const Volume<float> zero = distanceToBoundaryMm(none);
    for (const float d : zero.voxels())
        EXPECT_EQ(d, 0.0f);
}

}  // namespace
}  // namespace haustra::topology
