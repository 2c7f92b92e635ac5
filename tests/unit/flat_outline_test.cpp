#include "bench/flat_outline.h"

#include "analytic_tubes.h"
#include "bench/geodesic_frame.h"
#include "flatten/tube/conformal_tube.h"
#include "tube_meshes.h"

#include <cmath>

#include <gtest/gtest.h>

namespace haustra::bench {
namespace {

template <class Point>
std::vector<Point> ellipse(double longer, double shorter, double turn,
                           const std::function<Point(glm::dvec2)>& place) {
    std::vector<Point> points;
    for (int n = 0; n < 400; ++n) {
        const double angle = std::numbers::pi * n / 200.0;
        const glm::dvec2 p(longer * std::cos(angle), shorter * std::sin(angle));
        points.push_back(place({p.x * std::cos(turn) - p.y * std::sin(turn) + 7.0,
                                p.x * std::sin(turn) + p.y * std::cos(turn) - 3.0}));
    }
    return points;
}

TEST(FlatOutline, EllipsesHaveTheirShape) {
    for (const double turn : {0.0, 0.4, 1.5, 3.0}) {
        const auto flat = shapeOf(ellipse<glm::dvec2>(3.0, 2.0, turn, [](auto p) { return p; }));
        EXPECT_NEAR(flat.aspect, 1.5, 1e-6);
        EXPECT_NEAR(flat.area, 6.0 * std::numbers::pi, 1e-2);
        const glm::dvec3 u = glm::normalize(glm::dvec3(1.0, 2.0, -1.0)),
                         v = glm::normalize(glm::cross(u, glm::dvec3(0.3, 0.1, 1.0)));
        const auto tilted = shapeOf(fromAbove(
            ellipse<glm::dvec3>(3.0, 2.0, turn, [&](auto p) { return p.x * u + p.y * v; })));
        EXPECT_NEAR(tilted.aspect, 1.5, 1e-6);
        EXPECT_NEAR(tilted.area, 6.0 * std::numbers::pi, 1e-2);
    }
}

// Two ellipses of one shape: turned and grown they are alike, across each other they are not.
TEST(FlatOutline, StretchKnowsWhichWayAShapeLies) {
    const auto from = ellipse<glm::dvec2>(3.0, 2.0, 0.3, [](auto p) { return p; });
    const auto to = [&](glm::dmat2 map) {
        std::vector<glm::dvec2> places;
        for (const glm::dvec2 p : from)
            places.push_back(map * p + glm::dvec2(5.0, -8.0));
        return places;
    };
    for (const double turn : {0.0, 0.7, 2.5}) {
        const glm::dmat2 turned(std::cos(turn), std::sin(turn), -std::sin(turn), std::cos(turn));
        EXPECT_NEAR(stretchBetween(from, to(0.01 * turned)), 1.0, 1e-9);
        EXPECT_NEAR(stretchBetween(from, to(turned * glm::dmat2(1.2, 0.0, 0.0, 1.0))), 1.2, 1e-9);
        // Seen from behind.
        EXPECT_NEAR(stretchBetween(from, to(turned * glm::dmat2(-1.0, 0.0, 0.0, 1.0))), 1.0, 1e-9);
    }
    const auto across = ellipse<glm::dvec2>(2.0, 3.0, 0.3, [](auto p) { return p; });
    EXPECT_NEAR(shapeOf(across).aspect, shapeOf(from).aspect, 1e-9);
    EXPECT_NEAR(stretchBetween(from, across), 2.25, 1e-6);
}

std::function<double(glm::dvec3)> ball(glm::dvec3 centerMm, double radiusMm) {
    return [=](glm::dvec3 p) { return glm::distance(p, centerMm) - radiusMm; };
}

TriMesh cylinderMesh() {
    return tests::revolvedMesh(120, 100, 100.0, [](double) { return 20.0; });
}

// A cylinder unrolls without stretching: all distances from the middle are those in the plane.
TEST(FlatOutline, CylinderUnrollsToThePlane) {
    const TriMesh mesh = cylinderMesh();
    const auto edges = mesh::HalfedgeMesh::of(mesh);
    ASSERT_TRUE(edges);
    const auto plane = [](glm::dvec3 p) { return glm::dvec2(20.0 * std::atan2(p.y, p.x), p.z); };
    const glm::dvec2 middle(0.0, 50.0);
    std::vector<char> patch(mesh.vertices.size(), 0);
    for (std::size_t v = 0; v < patch.size(); ++v)
        patch[v] = glm::distance(plane(mesh.vertices[v]), middle) < 12.0;
    const auto places = unroll(mesh, *edges, patch);
    for (std::size_t v = 0; v < patch.size(); ++v) {
        if (!patch[v]) continue;
        EXPECT_NEAR(glm::length(places[v]), glm::distance(plane(mesh.vertices[v]), middle), 0.1);
    }
}

TEST(FlatOutline, HalfBallIsRoundOnTheSurfaceAndInThePlane) {
    const tests::HalfBall polyp{.middle = {0.98, 0.35}};
    const TriMesh mesh =
        tests::tubeMesh(200, 140, [&](double a, double s) { return polyp.position(a, 0.7 * s); });
    const auto edges = mesh::HalfedgeMesh::of(mesh);
    ASSERT_TRUE(edges);
    const auto map = flatten::conformalTube(mesh);
    ASSERT_TRUE(map);
    const glm::dvec3 center = tests::cylinder(polyp.circumferenceMm)(0.98, 0.35);
    const auto outline = outlineOf(mesh, *edges, map->map, ball(center, 1.1 * polyp.ballMm));
    ASSERT_TRUE(outline);
    for (const glm::dvec3& place : outline->placesMm)
        EXPECT_NEAR(glm::distance(place, center), 1.1 * polyp.ballMm, 1e-9);
    EXPECT_LT(shapeOf(outline->unrolledMm).aspect, 1.08);
    EXPECT_LT(shapeOf(outline->flat).aspect, 1.06);
    // With the wall's ring around it.
    const double ring = std::numbers::pi * 0.21 * polyp.ballMm * polyp.ballMm;
    EXPECT_NEAR(outline->insideMm2, polyp.areaMm2() + ring, 0.05 * polyp.areaMm2());
}

TEST(FlatOutline, NothingWhereTheBallMeetsARimOrNoWall) {
    const TriMesh mesh = cylinderMesh();
    const auto edges = mesh::HalfedgeMesh::of(mesh);
    const auto map = flatten::conformalTube(mesh);
    ASSERT_TRUE(edges && map);
    EXPECT_TRUE(outlineOf(mesh, *edges, map->map, ball({20.0, 0.0, 50.0}, 5.0)));
    EXPECT_FALSE(outlineOf(mesh, *edges, map->map, ball({20.0, 0.0, 2.0}, 5.0)));
    EXPECT_FALSE(outlineOf(mesh, *edges, map->map, ball({0.0, 0.0, 50.0}, 5.0)));
    EXPECT_FALSE(outlineOf(mesh, *edges, map->map, ball({0.0, 0.0, 50.0}, 25.0)));
}

}  // namespace
}  // namespace haustra::bench
