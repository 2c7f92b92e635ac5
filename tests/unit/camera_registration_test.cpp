// Laws of camera registration: each vertex looks from a near place of the centerline, and between
// neighbours that place does not jump.
#include "flatten/tube/camera_registration.h"

#include "flat_meshes.h"
#include "flatten/tube/flattening.h"
#include "flatten/tube/seam.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

using Curve = std::function<glm::dvec3(double)>;  // by arc

Centerline sampled(const Curve& curve, double lengthMm) {
    Centerline line;
    const int steps = int(std::lround(lengthMm));
    for (int n = 0; n <= steps; ++n) {
        CenterlinePoint point;
        point.positionMm = curve(lengthMm * n / steps);
        point.arcMm = lengthMm * n / steps;
        line.points.push_back(point);
    }
    return line;
}

/// A tube of `radiusMm` around a plane curve (in y and z), with the map of the cylinder that it is
/// bent from.
FlatMap tubeAround(const Curve& curve, double lengthMm, double radiusMm) {
    const int around = 40, rings = int(lengthMm / 1.5);
    TriMesh tube = tests::openTube([&](double) { return radiusMm; }, lengthMm, around, rings);
    const PeriodicMap map = tests::cylinderMap(tube, radiusMm);
    for (glm::dvec3& v : tube.vertices) {
        const glm::dvec3 at = curve(v.z),
                         along = glm::normalize(curve(v.z + 0.01) - curve(v.z - 0.01));
        v = at + v.x * glm::dvec3(1.0, 0.0, 0.0) + v.y * glm::cross(along, glm::dvec3(1, 0, 0));
    }
    return cutAlongSeam(tube, map, 0.3);
}

glm::dvec3 straight(double arc) {
    return {0.0, 0.0, arc};
}

/// Straight, half a circle of 14 mm, and back beside itself.
glm::dvec3 hairpin(double arc) {
    constexpr double legMm = 80.0, bendMm = 14.0;
    const double turn = bendMm * std::numbers::pi;
    if (arc < legMm) return {0.0, 0.0, arc};
    if (arc > legMm + turn) return {0.0, 2.0 * bendMm, 2.0 * legMm + turn - arc};
    const double a = (arc - legMm) / bendMm;
    return {0.0, bendMm * (1.0 - std::cos(a)), legMm + bendMm * std::sin(a)};
}
constexpr double hairpinMm = 160.0 + 14.0 * std::numbers::pi;

void expectSound(const FlatMap& map, const Centerline& centerline) {
    ASSERT_EQ(map.camera.size(), map.flat.size());
    ASSERT_GE(map.cameras.size(), 2u);
    EXPECT_LT(glm::distance(map.cameras.front().positionMm, centerline.points.front().positionMm),
              1e-9);
    EXPECT_LT(glm::distance(map.cameras.back().positionMm, centerline.points.back().positionMm),
              1e-9);
    const double spacingMm = map.cameras[1].arcMm - map.cameras[0].arcMm;
    EXPECT_EQ(map.cameras.front().arcMm, 0.0);
    EXPECT_NEAR(map.cameras.back().arcMm, centerline.lengthMm(), 1e-9);
    for (std::size_t c = 1; c < map.cameras.size(); ++c)
        EXPECT_NEAR(map.cameras[c].arcMm - map.cameras[c - 1].arcMm, spacingMm, 1e-9);
    std::map<std::tuple<double, double, double>, int> cameraAt;
    for (std::size_t v = 0; v < map.camera.size(); ++v) {
        ASSERT_GE(map.camera[v], 0);
        ASSERT_LT(std::size_t(map.camera[v]), map.cameras.size());
        // One place of the surface, one camera: on both sides of the seam.
        const glm::dvec3 p = map.surface.vertices[v];
        EXPECT_EQ(cameraAt.try_emplace({p.x, p.y, p.z}, map.camera[v]).first->second,
                  map.camera[v]);
    }
    for (const glm::ivec3& t : map.surface.triangles) {
        for (int c = 0; c < 3; ++c) {
            const auto a = std::size_t(t[c]), b = std::size_t(t[(c + 1) % 3]);
            const double edgeMm = glm::distance(map.surface.vertices[a], map.surface.vertices[b]);
            EXPECT_LE(std::abs(map.camera[a] - map.camera[b]) * spacingMm,
                      steepestRegistration * edgeMm + spacingMm + 1e-9);
        }
    }
}

/// How far a vertex's camera is farther from it than the nearest of all.
double excessMm(const FlatMap& map, std::size_t v) {
    double least = 1e300;
    for (const FlatCamera& camera : map.cameras)
        least = std::min(least, glm::distance(camera.positionMm, map.surface.vertices[v]));
    return glm::distance(map.cameras[std::size_t(map.camera[v])].positionMm,
                         map.surface.vertices[v]) -
           least;
}

TEST(CameraRegistration, InAStraightTubeEachVertexHasTheCameraBesideIt) {
    for (const double spacingMm : {0.5, 1.0, 3.0}) {
        FlatMap map = tubeAround(straight, 120.0, 12.0);
        const Centerline centerline = sampled(straight, 120.0);
        ASSERT_TRUE(registerCameras(map, centerline, {.cameraSpacingMm = spacingMm}));
        EXPECT_EQ(map.cameras.size(), std::size_t(std::lround(120.0 / spacingMm)) + 1);
        expectSound(map, centerline);
        for (std::size_t v = 0; v < map.camera.size(); ++v) {
            EXPECT_NEAR(map.cameras[std::size_t(map.camera[v])].arcMm, map.surface.vertices[v].z,
                        0.5 * spacingMm + 1e-6);
        }
    }
}

TEST(CameraRegistration, BeyondTheCenterlinesEndsItsEndsLook) {
    FlatMap map = tubeAround(straight, 120.0, 12.0);
    const Centerline centerline = sampled([](double arc) { return straight(arc + 30.0); }, 50.0);
    ASSERT_TRUE(registerCameras(map, centerline));
    expectSound(map, centerline);
    for (std::size_t v = 0; v < map.camera.size(); ++v) {
        const double expected = std::clamp(map.surface.vertices[v].z - 30.0, 0.0, 50.0);
        EXPECT_NEAR(map.cameras[std::size_t(map.camera[v])].arcMm, expected, 1.0);
    }
}

// Where a bend's inner wall is as near to the far leg as to its own, cameras must not jump across.
TEST(CameraRegistration, RoundAHairpinNoTriangleLooksFromTwoLegs) {
    for (const int segments : {0, 1, 4, 12, 60}) {
        SCOPED_TRACE(segments);
        FlatMap map = tubeAround(hairpin, hairpinMm, 12.0);
        const Centerline centerline = sampled(hairpin, hairpinMm);
        ASSERT_TRUE(registerCameras(map, centerline, {.segments = segments}));
        expectSound(map, centerline);
        std::size_t nearest = 0;
        for (std::size_t v = 0; v < map.camera.size(); ++v)
            nearest += excessMm(map, v) < 1.0;
        EXPECT_GT(double(nearest), 0.97 * double(map.camera.size()));
    }
}

// Two legs that touch, far apart along the centerline: only the segments tell them apart.
TEST(CameraRegistration, SegmentsKeepAwayTheOtherLegOfALoop) {
    FlatMap map = tubeAround(hairpin, hairpinMm, 13.5);
    const Centerline centerline = sampled(hairpin, hairpinMm);
    // A centerline that strays towards the other leg: by distance alone some walls would be its.
    Centerline strayed = centerline;
    for (CenterlinePoint& p : strayed.points) {
        const double leg = p.positionMm.y < 14.0 ? 1.0 : -1.0;
        if (p.positionMm.z < 80.0)
            p.positionMm.y += leg * 9.0 * std::sin(p.positionMm.z / 80.0 * std::numbers::pi);
    }
    ASSERT_TRUE(registerCameras(map, strayed));
    expectSound(map, strayed);
    for (std::size_t v = 0; v < map.camera.size(); ++v) {
        const double trueMm = map.flat[v].y * 2.0 * std::numbers::pi * 13.5;
        EXPECT_LT(std::abs(map.cameras[std::size_t(map.camera[v])].arcMm - trueMm), 45.0);
    }
}

TEST(CameraRegistration, TheSplineRoundsWhatShakesTheCenterline) {
    FlatMap map = tubeAround(straight, 120.0, 12.0);
    Centerline shaken = sampled(straight, 120.0);
    for (std::size_t n = 1; n + 1 < shaken.points.size(); ++n)
        shaken.points[n].positionMm.x += n % 2 ? 0.4 : -0.4;
    ASSERT_TRUE(registerCameras(map, shaken));
    double bend = 0.0;
    for (std::size_t c = 2; c < map.cameras.size(); ++c) {
        bend = std::max(
            bend, glm::length(map.cameras[c].positionMm - 2.0 * map.cameras[c - 1].positionMm +
                              map.cameras[c - 2].positionMm));
    }
    EXPECT_LT(bend, 0.05);  // 1.6 mm in the samples themselves
}

TEST(CameraRegistration, DoesNotDependOnTheNumberOfThreads) {
    FlatMap one = tubeAround(hairpin, hairpinMm, 12.0), four = one;
    const Centerline centerline = sampled(hairpin, hairpinMm);
    ASSERT_TRUE(registerCameras(one, centerline, {.threads = 1}));
    ASSERT_TRUE(registerCameras(four, centerline, {.threads = 4}));
    EXPECT_EQ(one.camera, four.camera);
}

TEST(CameraRegistration, RefusesWhatHasNothingToSeeFrom) {
    FlatMap map = tubeAround(straight, 30.0, 12.0);
    Centerline line = sampled(straight, 30.0);
    Centerline one = line, still = line;
    one.points.resize(1);
    for (CenterlinePoint& p : still.points)
        p.arcMm = 0.0;
    EXPECT_FALSE(registerCameras(map, {}));
    EXPECT_FALSE(registerCameras(map, one));
    EXPECT_FALSE(registerCameras(map, still));
    EXPECT_FALSE(registerCameras(map, line, {.cameraSpacingMm = 0.0}));
    EXPECT_FALSE(registerCameras(map, line, {.cameraSpacingMm = std::nan("")}));
    FlatMap empty;
    EXPECT_FALSE(registerCameras(empty, line));
}

}  // namespace
}  // namespace haustra::flatten
