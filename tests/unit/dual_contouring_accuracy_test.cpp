// The lumen's surface against shapes given by formulas, seen as a scanner sees them: blurred by a
// Gaussian, sampled at 0.75 × 0.75 × 1.05 mm, and noisy.
#include "contouring/dual_contouring.h"
#include "mesh_laws.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace haustra {
namespace {

using Distance = std::function<double(glm::dvec3)>;  // signed, mm, negative in the air

constexpr double airHu = -990.0, wallHu = 40.0, isoHu = -475.0, blurSigmaMm = 0.47;

struct Scan {
    Volume<std::int16_t> hu;
    Volume<std::uint8_t> lumen;
};

/// `airShare` is the blurred shape's share of air at a point.
Scan scanOf(const Distance& airShare, double noiseHu) {
    const Grid grid = axisAlignedGrid({44, 44, 34}, {0.75, 0.75, 1.05}, {-16.1, -16.3, -17.2});
    Scan scan{Volume<std::int16_t>(grid), Volume<std::uint8_t>(grid)};
    std::mt19937 random(1);
    std::normal_distribution<double> noise;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const double air = airShare(grid.patientFromVoxelPoint(grid.voxelAt(n)));
        const double hu = airHu * air + wallHu * (1.0 - air) + noiseHu * noise(random);
        scan.hu.writable()[n] = std::int16_t(std::lround(hu));
        scan.lumen.writable()[n] = hu < isoHu ? 1 : 0;
    }
    return scan;
}

Distance blurredWall(Distance shape) {
    return [=](glm::dvec3 p) {
        return 0.5 * std::erfc(shape(p) / (blurSigmaMm * std::numbers::sqrt2));
    };
}

/// A ball of air convolved with the Gaussian, in closed form.
Distance blurredBall(double radius) {
    return [=](glm::dvec3 p) {
        const double r = std::max(1e-3, glm::length(p)), s = blurSigmaMm;
        auto inner = [&](double x) { return std::erf(x / (s * std::numbers::sqrt2)); };
        auto bell = [&](double x) { return std::exp(-x * x / (2.0 * s * s)); };
        return 0.5 * (inner(radius + r) + inner(radius - r)) -
               s / (r * std::sqrt(2.0 * std::numbers::pi)) * (bell(r - radius) - bell(r + radius));
    };
}

struct SurfaceError {
    double meanMm = 0.0, biasMm = 0.0, percentile95Mm = 0.0;
    double normalDegrees = 0.0;  ///< mean angle between the triangles and the shape
};

SurfaceError errorOf(const TriMesh& mesh, const Distance& shape) {
    std::vector<std::pair<double, double>> errors;  // |distance|, area
    SurfaceError error;
    double area = 0.0;
    for (const glm::ivec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[std::size_t(t.x)], b = mesh.vertices[std::size_t(t.y)],
                         c = mesh.vertices[std::size_t(t.z)];
        const glm::dvec3 p = (a + b + c) / 3.0, normal = glm::cross(b - a, c - a);
        if (glm::any(glm::greaterThan(glm::abs(p), glm::dvec3(12.0)))) continue;
        const double weight = glm::length(normal), distance = shape(p);
        glm::dvec3 gradient;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 step(0.0);
            step[axis] = 1e-4;
            gradient[axis] = shape(p + step) - shape(p - step);
        }
        const double cosine = glm::dot(normal, gradient) / (weight * glm::length(gradient));
        area += weight;
        error.meanMm += weight * std::abs(distance);
        error.biasMm += weight * distance;
        error.normalDegrees += weight * glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
        errors.emplace_back(std::abs(distance), weight);
    }
    error.meanMm /= area;
    error.biasMm /= area;
    error.normalDegrees /= area;
    std::sort(errors.begin(), errors.end());
    double below = 0.0;
    for (const auto& [distance, weight] : errors) {
        error.percentile95Mm = distance;
        if ((below += weight) >= 0.95 * area) break;
    }
    return error;
}

SurfaceError errorOf(const Distance& airShare, const Distance& shape, double noiseHu) {
    const Scan scan = scanOf(airShare, noiseHu);
    return errorOf(*contouring::contourLumen(scan.hu, scan.lumen, isoHu), shape);
}

double torus(glm::dvec3 p) {
    const glm::dvec2 q(0.6 * p.x + 0.8 * p.z, p.y);
    return glm::length(glm::dvec2(glm::length(q) - 9.0, 0.6 * p.z - 0.8 * p.x)) - 4.0;
}
double tube(glm::dvec3 p) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 2.0, 3.0));
    return glm::length(p - axis * glm::dot(p, axis)) - 6.0;
}
/// A polyp of 3 mm radius in the middle of a wide lumen.
double polyp(glm::dvec3 p) {
    return std::max(3.0 - glm::length(p), glm::length(p) - 11.0);
}

TEST(DualContouringAccuracy, StandsWithinAFewHundredthsOfAMillimetre) {
    for (const Distance& shape : {Distance(torus), Distance(tube), Distance(polyp)}) {
        const SurfaceError clean = errorOf(blurredWall(shape), shape, 0.0);
        EXPECT_LT(clean.meanMm, 0.02);
        EXPECT_LT(std::abs(clean.biasMm), 0.01);
        EXPECT_LT(clean.percentile95Mm, 0.05);
        const SurfaceError noisy = errorOf(blurredWall(shape), shape, 40.0);
        EXPECT_LT(noisy.meanMm, 0.04);
        EXPECT_LT(std::abs(noisy.biasMm), 0.015);
        EXPECT_LT(noisy.percentile95Mm, 0.1);
    }
}

TEST(DualContouringAccuracy, TrianglesLieAlongTheWallAndNotAlongVoxels) {
    for (const Distance& shape : {Distance(torus), Distance(tube), Distance(polyp)}) {
        EXPECT_LT(errorOf(blurredWall(shape), shape, 0.0).normalDegrees, 4.0);
        EXPECT_LT(errorOf(blurredWall(shape), shape, 40.0).normalDegrees, 5.5);
    }
}

/// Blur alone moves the half-way HU of a ball inwards by σ²/R (to first order); nothing is added.
TEST(DualContouringAccuracy, HasNoBiasBesideTheBlurs) {
    for (double radius : {4.0, 6.0, 8.0}) {
        const auto ball = [=](glm::dvec3 p) { return glm::length(p) - radius; };
        const double blurBias = -blurSigmaMm * blurSigmaMm / radius;
        EXPECT_NEAR(errorOf(blurredBall(radius), ball, 0.0).biasMm, blurBias, 0.015) << radius;
    }
}

TEST(DualContouringAccuracy, EnclosesTheVolume) {
    const Scan ring = scanOf(blurredWall(torus), 15.0);
    const double ringMm3 = 2.0 * std::pow(std::numbers::pi, 2) * 9.0 * 16.0;
    EXPECT_NEAR(tests::signedVolumeMm3(*contouring::contourLumen(ring.hu, ring.lumen, isoHu)),
                ringMm3, 0.01 * ringMm3);
    const Scan ball = scanOf(blurredWall([](glm::dvec3 p) { return glm::length(p) - 10.0; }), 15.0);
    const double ballMm3 = 4.0 / 3.0 * std::numbers::pi * 1000.0;
    EXPECT_NEAR(tests::signedVolumeMm3(*contouring::contourLumen(ball.hu, ball.lumen, isoHu)),
                ballMm3, 0.01 * ballMm3);
}

/// Labels alone, as along a bridge: no wall in the HU. The surface must not follow the voxels'
/// stairs, whose faces stand some 30° from the shape.
TEST(DualContouringAccuracy, SmoothsTheStairsWhereHuShowNoWall) {
    Scan scan = scanOf(blurredWall(tube), 0.0);
    std::fill(scan.hu.writable().begin(), scan.hu.writable().end(), std::int16_t(20));
    const SurfaceError error = errorOf(*contouring::contourLumen(scan.hu, scan.lumen, isoHu), tube);
    EXPECT_LT(error.normalDegrees, 10.0);
    EXPECT_LT(error.meanMm, 0.15);
}

/// A voxel of noise on the wrong side of isoHu must not leave a dent as large as the voxel.
TEST(DualContouringAccuracy, ToleratesLabelsThatDisagreeWithTheHu) {
    Scan scan = scanOf(blurredWall(tube), 0.0);
    std::mt19937 random(2);
    std::normal_distribution<double> noise;
    for (std::size_t n = 0; n < scan.hu.voxels().size(); ++n)
        scan.lumen.writable()[n] = scan.hu[n] + 60.0 * noise(random) < isoHu ? 1 : 0;
    const SurfaceError error = errorOf(*contouring::contourLumen(scan.hu, scan.lumen, isoHu), tube);
    EXPECT_LT(error.meanMm, 0.04);
    EXPECT_LT(error.percentile95Mm, 0.12);
}

}  // namespace
}  // namespace haustra
