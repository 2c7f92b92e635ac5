// Flying along a centerline: positions, directions and ups.
#include "core/centerline.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace haustra {
namespace {

/// Samples of curve(t), t from 0 to 1, with chord lengths as arcs.
Centerline lineAlong(const std::function<glm::dvec3(double)>& curve, int count) {
    Centerline line;
    for (int n = 0; n < count; ++n) {
        CenterlinePoint point;
        point.positionMm = curve(double(n) / double(count - 1));
        point.radiusMm = 5.0 + n;
        if (n > 0) {
            const CenterlinePoint& last = line.points.back();
            point.arcMm = last.arcMm + glm::distance(point.positionMm, last.positionMm);
        }
        line.points.push_back(point);
    }
    return line;
}

Centerline helix() {
    return lineAlong(
        [](double t) {
            return glm::dvec3(30.0 * std::cos(9.0 * t), 30.0 * std::sin(9.0 * t), 70.0 * t);
        },
        400);
}

void expectNear(glm::dvec3 a, glm::dvec3 b, double tolerance) {
    EXPECT_LE(glm::distance(a, b), tolerance);
}

TEST(Centerline, PoseGoesThroughEachSampleAndHalfwayBetweenTwo) {
    const Centerline line = helix();
    for (std::size_t n = 0; n + 1 < line.points.size(); ++n) {
        const CenterlinePoint &a = line.points[n], &b = line.points[n + 1];
        expectNear(poseAtArc(line, a.arcMm).point.positionMm, a.positionMm, 1e-9);
        const CenterlinePose half = poseAtArc(line, 0.5 * (a.arcMm + b.arcMm));
        expectNear(half.point.positionMm, 0.5 * (a.positionMm + b.positionMm), 1e-9);
        EXPECT_NEAR(half.point.radiusMm, 0.5 * (a.radiusMm + b.radiusMm), 1e-9);
        EXPECT_NEAR(half.point.arcMm, 0.5 * (a.arcMm + b.arcMm), 1e-9);
    }
}

TEST(Centerline, PoseIsClampedToTheEnds) {
    const Centerline line = helix();
    expectNear(poseAtArc(line, -50.0).point.positionMm, line.points.front().positionMm, 0.0);
    expectNear(poseAtArc(line, 1e6).point.positionMm, line.points.back().positionMm, 0.0);
    EXPECT_NEAR(glm::length(poseAtArc(line, 1e6).tangent), 1.0, 1e-12);
}

TEST(Centerline, TangentIsTheCurvesOwn) {
    const Centerline line = helix();
    for (double t = 0.1; t < 0.9; t += 0.05) {
        const double arc =
            nearestArc(line, {30.0 * std::cos(9.0 * t), 30.0 * std::sin(9.0 * t), 70.0 * t});
        const CenterlinePose pose = poseAtArc(line, arc, 1.0);
        const double angle = std::atan2(pose.point.positionMm.y, pose.point.positionMm.x);
        const glm::dvec3 truth =
            glm::normalize(glm::dvec3(-270.0 * std::sin(angle), 270.0 * std::cos(angle), 70.0));
        expectNear(pose.tangent, truth, 0.01);
    }
}

TEST(Centerline, OneSampleIsEnough) {
    Centerline line;
    line.points.push_back({{1.0, 2.0, 3.0}, 0.0, 4.0, false});
    const CenterlinePose pose = poseAtArc(line, 7.0);
    expectNear(pose.point.positionMm, {1.0, 2.0, 3.0}, 0.0);
    EXPECT_NEAR(glm::length(pose.tangent), 1.0, 1e-12);
    EXPECT_EQ(nearestArc(line, {9.0, 9.0, 9.0}), 0.0);
    EXPECT_EQ(rotationMinimizingUps(line, {0.0, 0.0, 1.0}).size(), 1u);
    EXPECT_EQ(line.lengthMm(), 0.0);
    EXPECT_EQ(Centerline().lengthMm(), 0.0);
}

TEST(Centerline, NearestArcInvertsPose) {
    const Centerline line = helix();
    for (const CenterlinePoint& p : line.points)
        EXPECT_EQ(nearestArc(line, p.positionMm), p.arcMm);
}

TEST(Centerline, UpsAreUnitAndOrthogonalToTheTangent) {
    for (const glm::dvec3 preferred :
         {glm::dvec3(0, 0, 1), glm::dvec3(0, -3, 0), glm::dvec3(1, 1, 1)}) {
        const Centerline line = helix();
        const auto ups = rotationMinimizingUps(line, preferred);
        ASSERT_EQ(ups.size(), line.points.size());
        for (std::size_t n = 0; n < ups.size(); ++n) {
            EXPECT_NEAR(glm::length(ups[n]), 1.0, 1e-9);
            EXPECT_NEAR(glm::dot(ups[n], poseAtArc(line, line.points[n].arcMm).tangent), 0.0, 1e-9);
            EXPECT_GT(glm::dot(ups[n], ups[n > 0 ? n - 1 : 0]), 0.99);
        }
    }
}

TEST(Centerline, UpsDoNotTwistAlongAPlanarCurve) {
    // The plane's normal is carried along unchanged, through bends to both sides.
    const Centerline line = lineAlong(
        [](double t) { return glm::dvec3(100.0 * t, 20.0 * std::sin(12.0 * t), 0.0); }, 300);
    for (const glm::dvec3 up : rotationMinimizingUps(line, {0.2, 0.1, 5.0})) {
        EXPECT_GT(up.z, 0.99);
    }
    const auto exact = rotationMinimizingUps(line, {0.0, 0.0, 1.0});
    for (const glm::dvec3 up : exact)
        expectNear(up, {0.0, 0.0, 1.0}, 1e-9);
}

TEST(Centerline, UpsTurnAlongAHelixAsItsTorsionSays) {
    // Against the principal normal, the rotation-minimizing frame turns by the integral of the
    // torsion.
    const double a = 30.0, turn = 9.0, b = 70.0 / turn;
    const Centerline line = helix();
    const auto ups = rotationMinimizingUps(line, {1.0, 0.3, 0.2});
    const auto angleToNormal = [&](std::size_t n) {
        const glm::dvec3 t = poseAtArc(line, line.points[n].arcMm).tangent;
        const glm::dvec3 p = line.points[n].positionMm;
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-p.x, -p.y, 0.0));
        return std::atan2(glm::dot(glm::cross(normal, ups[n]), t), glm::dot(normal, ups[n]));
    };
    const std::size_t from = 20, to = 380;
    const double arc = line.points[to].arcMm - line.points[from].arcMm;
    const double expected = -arc * b / (a * a + b * b);
    EXPECT_NEAR(std::remainder(angleToNormal(to) - angleToNormal(from) - expected, 2.0 * M_PI), 0.0,
                0.03);
}

TEST(Centerline, APreferredUpAlongTheTangentStillGivesOne) {
    const Centerline line = lineAlong([](double t) { return glm::dvec3(0.0, 0.0, 50.0 * t); }, 50);
    for (const glm::dvec3 up : rotationMinimizingUps(line, {0.0, 0.0, 1.0})) {
        EXPECT_NEAR(glm::length(up), 1.0, 1e-9);
        EXPECT_NEAR(up.z, 0.0, 1e-9);
    }
}

}  // namespace
TEST(CameraAtArc, LooksAtThePathAheadOnACircle) {
    // On a circle of radius r the chord to s mm ahead leaves the tangent by the angle s / 2r.
    Centerline circle;
    const double radius = 60.0;
    for (int n = 0; n <= 300; ++n) {
        const double a = n / radius;
        circle.points.push_back(
            {{radius * std::cos(a), radius * std::sin(a), 0.0}, double(n), 10.0, false});
    }
    const auto ups = rotationMinimizingUps(circle, {0, 0, 1});
    for (FlightDirection direction : {FlightDirection::antegrade, FlightDirection::retrograde}) {
        const double sign = direction == FlightDirection::antegrade ? 1.0 : -1.0;
        const CenterlineCamera camera = cameraAtArc(circle, ups, 150.0, direction);
        const glm::dvec3 tangent = sign * poseAtArc(circle, 150.0).tangent;
        EXPECT_NEAR(std::acos(glm::dot(camera.forward, tangent)),
                    flightLookAheadMm / (2.0 * radius), 1e-3);
        EXPECT_LT(glm::dot(camera.forward, camera.positionMm), 0.0);  // into the bend
        EXPECT_NEAR(glm::dot(camera.up, camera.forward), 0.0, 1e-12);
        EXPECT_NEAR(glm::length(camera.up), 1.0, 1e-12);
    }
    // At the end the path is over: the camera looks straight on.
    const CenterlineCamera last = cameraAtArc(circle, ups, 300.0, FlightDirection::antegrade);
    EXPECT_LT(glm::distance(last.forward, poseAtArc(circle, 300.0).tangent), 1e-12);
}

}  // namespace haustra
