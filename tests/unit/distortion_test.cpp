// Maps whose distortion is known.
#include "flatten/distortion.h"

#include "flatten/tube/conformal_tube.h"
#include "tube_meshes.h"

#include <random>

#include <gtest/gtest.h>

using namespace haustra;
using flatten::measureDistortion;

namespace {

/// A flat square of `side`² cells in the plane z = 3, corners at right angles.
TriMesh flatSquare(int side) {
    TriMesh mesh;
    for (int j = 0; j <= side; ++j) {
        for (int i = 0; i <= side; ++i)
            mesh.vertices.push_back({double(i), double(j), 3.0});
    }
    const auto at = [&](int i, int j) { return j * (side + 1) + i; };
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

flatten::Distortion ofMap(const TriMesh& mesh, const std::function<glm::dvec2(glm::dvec3)>& map) {
    return measureDistortion(mesh, [&](std::size_t t, int c) {
        return map(mesh.vertices[std::size_t(mesh.triangles[t][c])]);
    });
}

}  // namespace

TEST(Distortion, OfASimilarityIsNone) {
    const auto found = ofMap(flatSquare(5), [](glm::dvec3 p) {
        return glm::dvec2(0.3 * p.x - 0.4 * p.y + 7.0, 0.4 * p.x + 0.3 * p.y);
    });
    EXPECT_LT(found.angleErrorDegrees.max, 1e-12);
    EXPECT_NEAR(found.angleFloorDegrees, 0.0, 1e-12);
    EXPECT_NEAR(found.dilatation.mean, 1.0, 1e-12);
    EXPECT_NEAR(found.dilatation.max, 1.0, 1e-12);
    EXPECT_LT(found.logAreaDeviation, 1e-12);
    EXPECT_NEAR(found.areaRange, 1.0, 1e-12);
    EXPECT_EQ(found.flips, 0u);
}

/// Twice as long one way: 45° and 45° become 26.57° and 63.43°.
TEST(Distortion, OfAStretch) {
    const auto found =
        ofMap(flatSquare(4), [](glm::dvec3 p) { return glm::dvec2(2.0 * p.x, p.y); });
    const double off = 45.0 - std::atan(0.5) * 180.0 / std::numbers::pi;
    EXPECT_NEAR(found.angleErrorDegrees.mean, 2.0 / 3.0 * off, 1e-10);
    EXPECT_NEAR(found.angleErrorDegrees.p95, off, 1e-10);
    EXPECT_NEAR(found.angleErrorDegrees.max, off, 1e-10);
    EXPECT_NEAR(found.dilatation.mean, 2.0, 1e-12);
    EXPECT_NEAR(found.dilatation.p999, 2.0, 1e-12);
    EXPECT_LT(found.logAreaDeviation, 1e-12);
}

TEST(Distortion, OfAreas) {
    // The right half is twice as large either way; the cells between are no part of the mesh.
    TriMesh mesh = flatSquare(6);
    std::erase_if(mesh.triangles, [&](const glm::ivec3& t) {
        const double left = mesh.vertices[std::size_t(t.x)].x;
        return left == 2.0 || left == 3.0;
    });
    const auto found = ofMap(mesh, [](glm::dvec3 p) {
        const double scale = p.x > 2.5 ? 2.0 : 1.0;
        return scale * glm::dvec2(p.x, p.y);
    });
    EXPECT_NEAR(found.logAreaDeviation, 0.5 * std::log(4.0), 1e-12);
    EXPECT_NEAR(found.areaRange, 4.0, 1e-12);
    EXPECT_NEAR(found.dilatation.max, 1.0, 1e-12);
}

TEST(Distortion, CountsFlips) {
    const TriMesh mesh = flatSquare(3);
    EXPECT_EQ(ofMap(mesh, [](glm::dvec3 p) { return glm::dvec2(-p.x, p.y); }).flips,
              mesh.triangles.size());
    EXPECT_EQ(ofMap(mesh, [](glm::dvec3 p) { return glm::dvec2(p.x, 0.0); }).flips,
              mesh.triangles.size());
    // One vertex pulled across the side opposite to it.
    const auto folded = ofMap(mesh, [](glm::dvec3 p) {
        return p.x == 1.0 && p.y == 1.0 ? glm::dvec2(1.0, 2.2) : glm::dvec2(p.x, p.y);
    });
    EXPECT_GT(folded.flips, 0u);
    EXPECT_LT(folded.flips, 6u);
}

/// Four equilateral triangles at a tip lack 120°, which 12 corners share.
TEST(Distortion, FloorIsTheLackOfAngleAtInnerVertices) {
    TriMesh mesh;
    mesh.vertices = {{0.0, 0.0, std::sqrt(0.5)},
                     {std::sqrt(0.5), 0.0, 0.0},
                     {0.0, std::sqrt(0.5), 0.0},
                     {-std::sqrt(0.5), 0.0, 0.0},
                     {0.0, -std::sqrt(0.5), 0.0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
    const auto found = ofMap(mesh, [](glm::dvec3 p) { return glm::dvec2(p.x, p.y); });
    EXPECT_NEAR(found.angleFloorDegrees, 10.0, 1e-10);
    // 60° becomes 90° at the tip and 45° at the foot.
    EXPECT_NEAR(found.angleErrorDegrees.mean, 20.0, 1e-10);
}

TEST(Distortion, IsNeverBelowTheFloor) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> rough(-1.0, 1.0);
    const TriMesh mesh = tests::revolvedMesh(30, 40, 80.0, [&](double s) {
        return 10.0 + 3.0 * std::cos(25.0 * s) + 0.2 * rough(random);
    });
    const auto made = flatten::conformalTube(mesh);
    ASSERT_TRUE(made);
    const auto found =
        measureDistortion(mesh, [&](std::size_t t, int c) { return made->map.corner(mesh, t, c); });
    EXPECT_EQ(found.flips, 0u);
    EXPECT_GT(found.angleFloorDegrees, 0.1);
    EXPECT_GE(found.angleErrorDegrees.mean, found.angleFloorDegrees);
    EXPECT_GE(found.angleErrorDegrees.p999, found.angleErrorDegrees.p95);
    EXPECT_GE(found.angleErrorDegrees.max, found.angleErrorDegrees.p999);
}

TEST(Distortion, LeavesOutTrianglesWithoutArea) {
    TriMesh mesh = flatSquare(2);
    mesh.triangles.push_back({0, 1, 2});  // along one side
    const auto found = ofMap(mesh, [](glm::dvec3 p) { return glm::dvec2(p.x, p.y); });
    EXPECT_EQ(found.flips, 1u);
    EXPECT_LT(found.angleErrorDegrees.max, 1e-12);
    EXPECT_TRUE(std::isfinite(found.dilatation.max));
    EXPECT_EQ(measureDistortion({}, [](std::size_t, int) { return glm::dvec2(0.0); }).flips, 0u);
}
