// Laws of the seam: cut along it the tube lies in one sheet whose two sides are one curve.
#include "flatten/tube/seam.h"

#include "flat_meshes.h"
#include "flatten/tube/flattening.h"
#include "mesh/halfedge_mesh.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

using tests::areaMm2;
using tests::cylinderMap;
using tests::openTube;

constexpr double radiusMm = 10.0, lengthMm = 50.0;

TriMesh cylinder(int around = 36, int rings = 31) {
    return openTube([](double) { return radiusMm; }, lengthMm, around, rings);
}

double flatArea(const FlatMap& map, std::size_t t) {
    const glm::ivec3 c = map.surface.triangles[t];
    const glm::dvec2 a = map.flat[std::size_t(c.x)];
    const glm::dvec2 u = map.flat[std::size_t(c.y)] - a, v = map.flat[std::size_t(c.z)] - a;
    return 0.5 * (u.x * v.y - u.y * v.x);
}

void expectSheet(const TriMesh& tube, const PeriodicMap& uncut, const FlatMap& map) {
    EXPECT_EQ(map.height, uncut.height);
    ASSERT_EQ(map.flat.size(), map.surface.vertices.size());
    ASSERT_EQ(map.sourceTriangle.size(), map.surface.triangles.size());
    EXPECT_EQ(seamMismatch(map), 0.0);
    std::size_t left = 0, right = 0;
    for (const glm::dvec2& at : map.flat) {
        EXPECT_GE(at.x, 0.0);
        EXPECT_LE(at.x, 1.0);
        EXPECT_GE(at.y, 0.0);
        EXPECT_LE(at.y, map.height);
        left += at.x == 0.0;
        right += at.x == 1.0;
    }
    EXPECT_EQ(left, right);
    EXPECT_GE(left, 2u);

    const auto halfedges = mesh::HalfedgeMesh::of(map.surface);
    ASSERT_TRUE(halfedges) << describe(halfedges.error());
    EXPECT_EQ(meshTopology(map.surface).eulerCharacteristic, 1);  // a disc
    EXPECT_NEAR(areaMm2(map.surface), areaMm2(tube), 1e-9 * areaMm2(tube));

    double sheet = 0.0;
    std::vector<double> area(tube.triangles.size(), 0.0);
    for (std::size_t t = 0; t < map.surface.triangles.size(); ++t) {
        EXPECT_GT(flatArea(map, t), 0.0);
        sheet += flatArea(map, t);
        const auto source = std::size_t(map.sourceTriangle[t]);
        const glm::ivec3 c = map.surface.triangles[t];
        area.at(source) += areaMm2(TriMesh{map.surface.vertices, {c}});
        // Its flat corners are the uncut map's, at the same place of the triangle.
        const glm::ivec3 whole = tube.triangles[source];
        const glm::dvec3 o = tube.vertices[std::size_t(whole.x)],
                         u = tube.vertices[std::size_t(whole.y)] - o,
                         v = tube.vertices[std::size_t(whole.z)] - o;
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 p = map.surface.vertices[std::size_t(c[corner])] - o;
            const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
            const double det = uu * vv - uv * uv;
            const double s = (vv * glm::dot(u, p) - uv * glm::dot(v, p)) / det,
                         r = (uu * glm::dot(v, p) - uv * glm::dot(u, p)) / det;
            EXPECT_NEAR(glm::length(p - s * u - r * v), 0.0, 1e-9);
            const glm::dvec2 a = uncut.corner(tube, source, 0);
            const glm::dvec2 expected = a + s * (uncut.corner(tube, source, 1) - a) +
                                        r * (uncut.corner(tube, source, 2) - a);
            EXPECT_NEAR(expected.y, map.flat[std::size_t(c[corner])].y, 1e-9);
        }
    }
    EXPECT_NEAR(sheet, uncut.height, 1e-9);
    for (std::size_t t = 0; t < area.size(); ++t)
        EXPECT_NEAR(area[t], areaMm2(TriMesh{tube.vertices, {tube.triangles[t]}}), 1e-9);
}

TEST(Seam, CutAnywhereTheTubeIsOneSheet) {
    const TriMesh tube = cylinder();
    const PeriodicMap map = cylinderMap(tube, radiusMm);
    // Between vertices, through them, and a hair beside them.
    for (const double seam :
         {0.013, 0.5, 0.5 + 1e-14, 0.5 - 1e-14, 0.5 + 1e-9, 1.0 / 36.0, 0.0, 0.999, 0.25 - 1e-7}) {
        SCOPED_TRACE(seam);
        const FlatMap cut = cutAlongSeam(tube, map, seam);
        expectSheet(tube, map, cut);
        for (std::size_t v = 0; v < cut.flat.size(); ++v) {
            const glm::dvec3 p = cut.surface.vertices[v];
            double x = std::atan2(p.y, p.x) / (2.0 * std::numbers::pi) - seam - cut.flat[v].x;
            x -= std::round(x);
            // A chord of the cylinder's polygon is not quite at its angle.
            EXPECT_NEAR(x, 0.0, 2e-4);
        }
    }
}

TEST(Seam, CutsSkewedTrianglesOnceOrTwice) {
    // Sheared by several turns, with corners far apart: triangles that hold two seams.
    const TriMesh tube = cylinder(5, 4);
    for (const double shear : {0.1, 0.6, 1.3}) {
        PeriodicMap map = cylinderMap(tube, radiusMm);
        const PeriodicMap straight = map;
        for (std::size_t v = 0; v < map.flat.size(); ++v) {
            const double x = map.flat[v].x + shear * map.flat[v].y;
            map.flat[v].x = x - std::floor(x);
        }
        for (std::size_t t = 0; t < map.turns.size(); ++t) {
            for (int c = 0; c < 3; ++c) {
                const glm::dvec2 was = straight.corner(tube, t, c);
                const double x = was.x + shear * was.y;
                map.turns[t][std::size_t(c)] =
                    std::int8_t(std::lround(x - map.flat[std::size_t(tube.triangles[t][c])].x));
            }
        }
        for (const double seam : {0.05, 0.37, 0.8}) {
            SCOPED_TRACE(testing::Message() << shear << " " << seam);
            expectSheet(tube, map, cutAlongSeam(tube, map, seam));
        }
    }
}

TEST(Seam, AVertexAHairAwayLeavesNoSliver) {
    const TriMesh tube = cylinder();
    PeriodicMap map = cylinderMap(tube, radiusMm);
    const FlatMap through = cutAlongSeam(tube, map, 0.5);
    const FlatMap beside = cutAlongSeam(tube, map, 0.5 + 1e-10);
    EXPECT_EQ(beside.surface.triangles.size(), through.surface.triangles.size());
    EXPECT_GT(tests::leastAngleDegrees(beside.surface), 15.0);
}

TEST(Seam, RunsWhereTheTubeBendsLeast) {
    // Folds on all but a strip of 40° round 200°.
    TriMesh tube = cylinder(120, 100);
    const PeriodicMap map = cylinderMap(tube, radiusMm);
    const auto away = [](double degrees, double from) {
        double step = std::fmod(degrees - from + 540.0, 360.0) - 180.0;
        return std::abs(step);
    };
    for (glm::dvec3& v : tube.vertices) {
        const double degrees = std::atan2(v.y, v.x) * 180.0 / std::numbers::pi + 360.0;
        const double depth = std::clamp((away(degrees, 200.0) - 20.0) / 20.0, 0.0, 1.0);
        const double shrink = 1.0 - 0.3 * depth * std::pow(std::sin(v.z * 0.4), 2.0);
        v.x *= shrink, v.y *= shrink;
    }
    const double seam = bestSeam(tube, map);
    EXPECT_LT(away(seam * 360.0, 200.0), 12.0);

    // Away from a place in that strip, and from it alone.
    SeamOptions options;
    options.keepAwayMm = {{radiusMm * std::cos(200.0 * std::numbers::pi / 180.0),
                           radiusMm * std::sin(200.0 * std::numbers::pi / 180.0), 20.0}};
    options.keepAwayRadiusMm = 5.0;
    const double other = bestSeam(tube, map, options);
    EXPECT_GT(away(other * 360.0, 200.0), 29.0);  // 5 mm of 10 mm radius
    options.keepAwayMm[0] *= 4.0;                 // nowhere near
    EXPECT_EQ(bestSeam(tube, map, options), seam);
    // Where no place is free, the one with the fewest is taken.
    options.keepAwayMm.clear();
    for (int degrees = 0; degrees < 360; degrees += 20) {
        const double a = degrees * std::numbers::pi / 180.0;
        for (int n = 0; n < (degrees == 80 ? 1 : 3); ++n)
            options.keepAwayMm.push_back({radiusMm * std::cos(a), radiusMm * std::sin(a), 20.0});
    }
    EXPECT_LT(away(bestSeam(tube, map, options) * 360.0, 80.0), 31.0);
}

TEST(Seam, MismatchIsSeen) {
    const TriMesh tube = cylinder();
    FlatMap map = cutAlongSeam(tube, cylinderMap(tube, radiusMm), 0.2);
    std::size_t v = 0;
    while (map.flat[v].x != 1.0 || map.flat[v].y < 0.1)
        ++v;
    map.flat[v].y += 1e-6;
    EXPECT_NEAR(seamMismatch(map), 1e-6, 1e-12);
    map.surface.vertices[v].x += 1e-6;
    EXPECT_EQ(seamMismatch(map), 1.0);
}

}  // namespace
}  // namespace haustra::flatten
