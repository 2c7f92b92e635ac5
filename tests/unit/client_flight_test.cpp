// Laws of the fly-through: where the camera is, how it turns, how the hand leaves and finds the
// path.
#include "reader/flight.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace haustra::reader {
namespace {

// A helix of some 470 mm: curved and twisted everywhere.
Centerline helix() {
    Centerline path;
    for (int n = 0; n <= 400; ++n) {
        const double t = n / 400.0 * 12.0;
        CenterlinePoint point;
        point.positionMm = {30 * std::cos(t), 30 * std::sin(t), 25 * t};
        point.radiusMm = 15;
        if (n > 0)
            point.arcMm = path.points.back().arcMm +
                          glm::distance(point.positionMm, path.points.back().positionMm);
        path.points.push_back(point);
    }
    return path;
}

void expectOrthonormal(const Camera& camera) {
    EXPECT_NEAR(glm::length(camera.forward), 1.0, 1e-12);
    EXPECT_NEAR(glm::length(camera.up), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(camera.forward, camera.up), 0.0, 1e-12);
}

void expectSame(const Camera& a, const Camera& b, double tolerance) {
    EXPECT_LT(glm::distance(a.positionMm, b.positionMm), tolerance);
    EXPECT_LT(glm::distance(a.forward, b.forward), tolerance);
    EXPECT_LT(glm::distance(a.up, b.up), tolerance);
}

TEST(Flight, LooksExactlyWhereTheCenterlineCameraLooks) {
    const Centerline path = helix();
    const auto ups = rotationMinimizingUps(path, flightPreferredUp);
    Flight flight(path);
    for (const auto direction : {FlightDirection::antegrade, FlightDirection::retrograde}) {
        flight.setDirection(direction);
        for (double arc = -10.0; arc < path.lengthMm() + 20.0; arc += 7.3) {
            flight.goTo(arc);
            const CenterlineCamera expected = cameraAtArc(path, ups, arc, direction);
            EXPECT_EQ(flight.camera().positionMm, expected.positionMm);
            EXPECT_EQ(flight.camera().forward, expected.forward);
            EXPECT_EQ(flight.camera().up, expected.up);
        }
    }
}

TEST(Flight, GoesAsFarAsSpeedTimesTimeAndPausesAtTheEnd) {
    Flight flight(helix());
    flight.setSpeed(40.0);
    flight.goTo(100.0);
    flight.advance(1.0);
    EXPECT_EQ(flight.arcMm(), 100.0);  // paused
    flight.setMotion(Motion::forward);
    for (int n = 0; n < 50; ++n)
        flight.advance(0.01);
    EXPECT_NEAR(flight.arcMm(), 120.0, 1e-9);
    flight.advance(1e6);
    EXPECT_EQ(flight.arcMm(), flight.centerline().lengthMm());
    EXPECT_EQ(flight.motion(), Motion::paused);
}

TEST(Flight, DirectionAndMotionDecideTheWayAndOnlyDirectionTheGaze) {
    Flight flight(helix());
    flight.setSpeed(10.0);
    const auto arcAfter = [&](FlightDirection direction, Motion motion) {
        flight.goTo(200.0);
        flight.setDirection(direction);
        flight.setMotion(motion);
        flight.advance(1.0);
        return flight.arcMm();
    };
    EXPECT_NEAR(arcAfter(FlightDirection::antegrade, Motion::forward), 210.0, 1e-9);
    const glm::dvec3 gaze = (flight.goTo(200.0), flight.camera().forward);
    EXPECT_NEAR(arcAfter(FlightDirection::antegrade, Motion::backward), 190.0, 1e-9);
    EXPECT_EQ((flight.goTo(200.0), flight.camera().forward), gaze);
    EXPECT_NEAR(arcAfter(FlightDirection::retrograde, Motion::forward), 190.0, 1e-9);
    EXPECT_LT(glm::dot((flight.goTo(200.0), flight.camera().forward), gaze), -0.5);
    EXPECT_NEAR(arcAfter(FlightDirection::retrograde, Motion::backward), 210.0, 1e-9);
}

TEST(Flight, YawTurnsRightAndPitchTurnsUp) {
    Flight flight(helix());
    flight.goTo(150.0);
    const Camera straight = flight.camera();
    const glm::dvec3 right = glm::cross(straight.forward, straight.up);
    flight.setLook(90.0, 0.0);
    EXPECT_LT(glm::distance(flight.camera().forward, right), 1e-12);
    EXPECT_LT(glm::distance(flight.camera().up, straight.up), 1e-12);
    flight.setLook(0.0, 60.0);
    EXPECT_NEAR(glm::dot(flight.camera().forward, straight.up), std::sin(glm::radians(60.0)),
                1e-12);
    flight.setLook(0.0, 1000.0);
    EXPECT_EQ(flight.pitchDegrees(), Flight::maxPitchDegrees);
    flight.resetLook();
    expectSame(flight.camera(), straight, 1e-15);
}

TEST(Flight, StaysOrthonormalUnderAnyLooking) {
    Flight flight(helix());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> degrees(-40.0, 40.0), mm(-5.0, 5.0);
    for (int n = 0; n < 2000; ++n) {
        if (n == 1000) flight.flyFreely();
        flight.look(degrees(random), degrees(random));
        if (n < 1000)
            flight.goTo(flight.arcMm() + mm(random));
        else
            flight.moveFreely({mm(random), mm(random), mm(random)});
        expectOrthonormal(flight.camera());
    }
}

TEST(Flight, LeavingThePathKeepsTheViewAndReturningFindsTheNearestPoint) {
    Flight flight(helix());
    flight.goTo(222.0);
    flight.setLook(12.0, -8.0);
    const Camera before = flight.camera();
    flight.flyFreely();
    EXPECT_TRUE(flight.isFree());
    expectSame(flight.camera(), before, 1e-15);
    flight.moveFreely({2.0, 1.0, 3.0});
    EXPECT_NEAR(glm::distance(flight.camera().positionMm, before.positionMm), std::sqrt(14.0),
                1e-12);
    const double nearest = nearestArc(flight.centerline(), flight.camera().positionMm);
    flight.returnToCenterline();
    EXPECT_FALSE(flight.isFree());
    EXPECT_EQ(flight.arcMm(), nearest);
}

TEST(Flight, GoingToAStoredViewShowsThatView) {
    Flight flight(helix()), other(helix());
    std::mt19937 random(11);
    std::uniform_real_distribution<double> arc(0.0, 470.0), yaw(-80.0, 80.0), pitch(-80.0, 80.0);
    for (int n = 0; n < 200; ++n) {
        flight.setDirection(n % 2 ? FlightDirection::antegrade : FlightDirection::retrograde);
        flight.goTo(arc(random));
        flight.setLook(yaw(random), pitch(random));
        if (n % 5 == 0) {
            flight.flyFreely();
            flight.moveFreely({1.0, 4.0, -2.0});
        }
        other.goTo(flight.camera(), flight.arcMm());
        EXPECT_EQ(other.isFree(), n % 5 == 0);
        expectSame(other.camera(), flight.camera(), 1e-9);
    }
}

TEST(Flight, WithoutAPathOnlyFreeFlightMoves) {
    Flight flight{Centerline{}};
    flight.setMotion(Motion::forward);
    flight.advance(1.0);
    flight.goTo(10.0);
    flight.returnToCenterline();
    EXPECT_TRUE(flight.isFree());
    const Camera before = flight.camera();
    flight.moveFreely({0, 0, 5});
    EXPECT_NEAR(glm::distance(flight.camera().positionMm, before.positionMm), 5.0, 1e-12);
}

}  // namespace
}  // namespace haustra::reader
