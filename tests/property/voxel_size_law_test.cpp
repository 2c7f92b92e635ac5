// What cleansing measures of the scanner, and what it does, at any voxel size.
#include "cleansing/point_spread.h"
#include "cleansing/tagged_surroundings.h"
#include "cleansing_scenes.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::test;

namespace {

cleansing::LocalMeans meansOf(const Scene& scene, int threads = 2) {
    return cleansing::measureLocalMeans(scene.scan, scene.tissue, scene.labels,
                                        cleansing::taggedSurroundings(scene.labels, threads),
                                        threads);
}

/// Adds noise whose grain is 1.1 mm wide (full width at half maximum) in the plane.
void addGrainyNoise(Scene& scene, double sdHu) {
    const Grid& grid = scene.scan.hu.grid();
    std::mt19937 random(11);
    std::normal_distribution<double> white;
    const glm::dvec3 sigma = glm::dvec3(1.1 / 2.355) / grid.spacingMm();
    const auto kernel = [](double sd) {
        std::vector<double> w;
        for (int n = -4; n <= 4; ++n)
            w.push_back(std::exp(-0.5 * n * n / (sd * sd)));
        double squares = 0.0;
        for (const double x : w)
            squares += x * x;
        for (double& x : w)
            x /= std::sqrt(squares);
        return w;
    };
    const auto alongX = kernel(sigma.x), alongY = kernel(sigma.y);
    const auto out = scene.scan.hu.writable();
    const int nx = grid.size.x, ny = grid.size.y;
    for (int k = 0; k < grid.size.z; ++k) {
        std::vector<double> grain(std::size_t((nx + 8) * (ny + 8)));
        for (double& g : grain)
            g = white(random);
        const auto at = [&](int i, int j) {
            return grain[std::size_t((i + 4) + (nx + 8) * (j + 4))];
        };
        for (int j = 0; j < ny; ++j) {
            for (int i = 0; i < nx; ++i) {
                double sum = 0.0;
                for (int b = -4; b <= 4; ++b) {
                    for (int a = -4; a <= 4; ++a)
                        sum += alongX[std::size_t(a + 4)] * alongY[std::size_t(b + 4)] *
                               at(i + a, j + b);
                }
                std::int16_t& hu = out[grid.index(i, j, k)];
                hu = std::int16_t(std::max(-1024L, std::lround(hu + sdHu * sum)));
            }
        }
    }
}

class AtPixels : public testing::TestWithParam<double> {
protected:
    glm::dvec3 spacingMm() const { return {GetParam(), GetParam(), std::max(0.5, GetParam())}; }
};

TEST_P(AtPixels, NoiseIsThatOfOneVoxelInEachMaterial) {
    Scene scene = tubeWithLevel(650.0, 0.0, 0.0, spacingMm());
    addGrainyNoise(scene, 15.0);
    const cleansing::NoiseSd noise = meansOf(scene).noise;
    EXPECT_NEAR(noise.gas, 15.0, 0.75);
    EXPECT_NEAR(noise.soft, 15.0, 0.75);
    EXPECT_NEAR(noise.tagged, 15.0, 0.75);
}

TEST_P(AtPixels, TheRimIsCleanAlike) {
    const Scene scene = tubeWithLevel(650.0, 10.0, 2.0, spacingMm());
    const CleansedScene one = cleanseScene(scene, 1), many = cleanseScene(scene, 5);
    EXPECT_TRUE(std::ranges::equal(one.cleansed.hu.voxels(), many.cleansed.hu.voxels()));
    EXPECT_TRUE(std::ranges::equal(one.cleansed.lumen.voxels(), many.cleansed.lumen.voxels()));
    const auto rim = errorWhere(scene, one.cleansed, [](Shares, glm::dvec3 p) {
        const glm::dvec2 d = glm::dvec2(p) - glm::dvec2(20.7, 20.55);
        return std::abs(d.y - 2.0) < 1.5 && std::abs(glm::length(d) - 12.0) < 1.5;
    });
    ASSERT_GT(rim.count, 100);
    EXPECT_NEAR(rim.bias, 0.0, 35.0);
    EXPECT_LT(rim.rmse, 70.0);
    const auto level = errorWhere(scene, one.cleansed, [](Shares, glm::dvec3 p) {
        const glm::dvec2 d = glm::dvec2(p) - glm::dvec2(20.7, 20.55);
        return std::abs(d.y - 2.0) < 2.0 && std::abs(d.x) < 8.0;
    });
    EXPECT_NEAR(level.bias, 0.0, 5.0);
    EXPECT_LT(level.rmse, 18.0);
}

INSTANTIATE_TEST_SUITE_P(Pixels, AtPixels, testing::Values(0.35, 0.5, 0.68, 0.8, 0.98));

/// A ball of gas over fluid in soft tissue, blurred by an ellipsoid.
Scene blurredBall(glm::dvec3 sdMm, glm::dvec3 spacingMm) {
    const glm::dvec3 middle(20.3, 20.6, 20.1);
    return makeScene(
        glm::ivec3(41.0 / spacingMm), 650.0, 12.0,
        [=](glm::dvec3 p) {
            const auto inside = [&](double mm, glm::dvec3 normal) {
                return 0.5 * std::erfc(-mm / (glm::length(normal * sdMm) * std::sqrt(2.0)));
            };
            const double away = glm::distance(p, middle);
            const double open = inside(14.0 - away, (p - middle) / std::max(away, 1e-6));
            const double fluid = inside(p.y - middle.y - 5.0, {0, 1, 0});
            return Shares{open * (1.0 - fluid), open * fluid};
        },
        spacingMm);
}

struct Spread {
    glm::dvec3 sdMm, spacingMm;
};

class PointSpreadLaw : public testing::TestWithParam<Spread> {};

TEST_P(PointSpreadLaw, IsMeasuredAlongEachAxis) {
    const auto [sdMm, spacingMm] = GetParam();
    const Scene scene = blurredBall(sdMm, spacingMm);
    const cleansing::LocalMeans means = meansOf(scene);
    const auto found = cleansing::measurePointSpread(scene.scan, scene.labels, means, 1);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(found.sdMm[axis] / sdMm[axis], 1.0, 0.05) << axis;
    EXPECT_EQ(found.sdMm, cleansing::measurePointSpread(scene.scan, scene.labels, means, 3).sdMm);
}

INSTANTIATE_TEST_SUITE_P(Spreads, PointSpreadLaw,
                         testing::Values(Spread{{0.45, 0.45, 0.9}, {0.5, 0.5, 1.0}},
                                         Spread{{0.45, 0.45, 0.9}, {0.7, 0.7, 1.0}},
                                         Spread{{0.6, 0.6, 0.45}, {0.68, 0.68, 0.5}},
                                         Spread{{0.5, 0.5, 0.7}, {0.98, 0.98, 1.0}},
                                         Spread{{0.4, 0.4, 0.4}, {0.35, 0.35, 0.4}}));

}  // namespace
