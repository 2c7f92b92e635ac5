// Lenses against formulas, OpenCV, and themselves there and back; the source's colonoscope.
#include "coverage/calibrate.h"
#include "coverage/colonoscope.h"
#include "coverage/fisheye_lens.h"
#include "coverage/lens_projection.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace haustra::coverage {
namespace {

constexpr double pi = std::numbers::pi;

std::vector<FisheyeLens> lenses() {
    std::vector<FisheyeLens> all{olympusCfQ160l().lens,
                                 {{1.0, -0.08, 0.4, -0.26, 0.03}, 137.0, 136.5, 162.0, 161.0},
                                 {{12.0, 0.4, 0.0, 0.0, 0.0}, 20.0, 22.0, 300.0, 200.0}};
    for (const auto projection :
         {Projection::equidistance, Projection::stereographic, Projection::equisolid,
          Projection::orthogonal, Projection::perspective})
        all.push_back({{1.4, 0, 0, 0, 0}, 180.0, 175.0, 310.0, 255.0, projection});
    FisheyeLens brown{{1.0, -0.488, 0.347, -0.145, 0.0}, 650.0, 649.0, 420.0, 361.0};
    brown.projection = Projection::perspective;
    all.push_back(brown);
    brown.decentring = {0.003, -0.002};
    all.push_back(brown);
    return all;
}

TEST(FisheyeLens, EveryDirectionComesBackFromItsPixel) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (const FisheyeLens& lens : lenses()) {
        ASSERT_TRUE(checkLens(lens));
        // Where the radius hardly grows, a pixel tells an angle badly; so do those of a tangent.
        const bool perspective = lens.projection == Projection::perspective;
        const double most = (perspective ? 0.7 : 0.97) * std::min(largestAngle(lens), 3.0);
        for (int n = 0; n < 500; ++n) {
            const double theta = n == 0 ? 0.0 : most * share(random), phi = 2 * pi * share(random);
            const glm::dvec3 direction(std::sin(theta) * std::cos(phi),
                                       std::sin(theta) * std::sin(phi), std::cos(theta));
            const auto pixel = pixelOf(lens, 7.0 * direction);
            ASSERT_TRUE(pixel);
            const auto back = directionOf(lens, *pixel);
            ASSERT_TRUE(back);
            EXPECT_LT(glm::distance(*back, direction), 1e-9) << theta << " " << phi;
            if (lens.decentring != std::array{0.0, 0.0}) continue;
            EXPECT_NEAR(pixel->x, lens.mu * radiusOf(lens, theta) * std::cos(phi) + lens.u0, 1e-9);
            EXPECT_NEAR(pixel->y, lens.mv * radiusOf(lens, theta) * std::sin(phi) + lens.v0, 1e-9);
            EXPECT_NEAR(angleOf(lens, radiusOf(lens, theta)).value(), theta, 1e-9);
        }
    }
}

// Equations 2.1 to 2.5 with f = 1.4; the source prints the last with 2f, which is no orthogonal
// projection: a hemisphere seen from afar has the radius f, not 2f.
TEST(FisheyeLens, ProjectionsAreTheSourcesEquations) {
    FisheyeLens lens{{1.4, 0, 0, 0, 0}};
    for (const double t : {0.1, 0.5, 1.0, 1.5}) {
        lens.projection = Projection::perspective;
        EXPECT_NEAR(radiusOf(lens, t), 1.4 * std::tan(t), 1e-12);
        lens.projection = Projection::stereographic;
        EXPECT_NEAR(radiusOf(lens, t), 2 * 1.4 * std::tan(t / 2), 1e-12);
        lens.projection = Projection::equidistance;
        EXPECT_NEAR(radiusOf(lens, t), 1.4 * t, 1e-12);
        lens.projection = Projection::equisolid;
        EXPECT_NEAR(radiusOf(lens, t), 2 * 1.4 * std::sin(t / 2), 1e-12);
        lens.projection = Projection::orthogonal;
        EXPECT_NEAR(radiusOf(lens, t), 1.4 * std::sin(t), 1e-12);
    }
    lens.projection = Projection::orthogonal;
    EXPECT_NEAR(largestAngle(lens), pi / 2, 1e-12);
    EXPECT_FALSE(pixelOf(lens, {1.0, 0.0, -0.01}));
}

TEST(FisheyeLens, RadiusGrowsExactlyToTheLargestAngle) {
    for (const FisheyeLens& lens : lenses()) {
        const double most = largestAngle(lens);
        double last = 0.0;
        for (int n = 1; n <= 2000; ++n) {
            const double r = radiusOf(lens, most * n / 2000.0);
            EXPECT_GT(r, last);
            last = r;
        }
        EXPECT_FALSE(angleOf(lens, last * 1.0001));
    }
    // 13.5747 − 3·2.2982θ² is 0 there.
    EXPECT_NEAR(largestAngle(olympusCfQ160l().lens), std::sqrt(13.5747 / (3 * 2.2982)), 1e-12);
    // It would grow again beyond: 1 − 3θ²·0.5 + 5θ⁴·0.2 has roots at θ² = 0.5 ± …, or none.
    const FisheyeLens twice{{1.0, -0.5, 0.1, 0.0, 0.0}};
    EXPECT_NEAR(largestAngle(twice), 1.0, 1e-9);  // 1 − 1.5θ² + 0.5θ⁴ = (1 − θ²)(1 − θ²/2)
}

TEST(FisheyeLens, OpenCvShowsTheSamePixels) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> aside(-0.6, 0.6);
    std::vector<cv::Point3d> points;
    for (int n = 0; n < 50; ++n)
        points.emplace_back(aside(random), aside(random), 1.0);
    const cv::Vec3d none(0, 0, 0);
    for (const FisheyeLens& lens : lenses()) {
        if (lens.k[0] != 1.0) continue;
        const cv::Matx33d camera(lens.mu, 0, lens.u0, 0, lens.mv, lens.v0, 0, 0, 1);
        std::vector<cv::Point2d> shown;
        if (lens.projection == Projection::perspective)
            cv::projectPoints(points, none, none, camera,
                              cv::Vec<double, 5>(lens.k[1], lens.k[2], lens.decentring[0],
                                                 lens.decentring[1], lens.k[3]),
                              shown);
        else
            cv::fisheye::projectPoints(points, shown, none, none, camera,
                                       cv::Vec4d(lens.k[1], lens.k[2], lens.k[3], lens.k[4]));
        for (std::size_t n = 0; n < points.size(); ++n) {
            const auto pixel = pixelOf(lens, {points[n].x, points[n].y, points[n].z});
            ASSERT_TRUE(pixel);
            EXPECT_NEAR(pixel->x, shown[n].x, 1e-9);
            EXPECT_NEAR(pixel->y, shown[n].y, 1e-9);
        }
    }
}

// Table 2.1 and §2.5.
TEST(Colonoscope, OlympusIsTheSources) {
    const Colonoscope scope = olympusCfQ160l();
    EXPECT_EQ(scope.fieldDegrees, 140.0);
    EXPECT_EQ(scope.nearestMm, 3.0);
    EXPECT_EQ(scope.farthestMm, 100.0);
    EXPECT_EQ(2.0 * scope.tipRadiusMm, 12.8);
    const auto numbers = numbersOf(scope.lens);
    const std::array source{13.5747, -2.2982, 0.0, 0.0, 0.0, 25.5903, 25.6, 274.2596, 220.6445};
    for (std::size_t n = 0; n < source.size(); ++n)
        EXPECT_EQ(numbers[n], source[n]) << lensNumberNames()[n];
    // Half of the field lies within what the lens shows, and its circle is about the open ellipse.
    EXPECT_GT(glm::degrees(largestAngle(scope.lens)), 70.0);
    const double edge = scope.lens.mu * radiusOf(scope.lens, glm::radians(70.0));
    EXPECT_NEAR(edge, scope.openRadii.x, 0.05 * edge);
    // What is dark shows nothing, and the middle looks ahead.
    EXPECT_FALSE(directionOf(scope, {0.0, 0.0}));
    EXPECT_NEAR(directionOf(scope, {274.2596, 220.6445})->z, 1.0, 1e-12);
    // The calibration is nearly an orthogonal lens: k₂/k₁ of f sin θ is −1/6.
    EXPECT_NEAR(scope.lens.k[1] / scope.lens.k[0], -1.0 / 6.0, 0.005);
}

}  // namespace
}  // namespace haustra::coverage
