#include "core/flat_lookup.h"

#include "analytic_tubes.h"
#include "core/triangle_tree.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace haustra {
namespace {

using tests::flatMapOf;

constexpr double heightUnits = 4.0;
constexpr double circumferenceMm = 150.0;

double uniform(std::mt19937& random, double low, double high) {
    return low + (high - low) * double(random()) / 4294967296.0;
}

double turnsApart(double a, double b) {
    return std::abs(std::remainder(a - b, 1.0));
}

FlatLookup lookupOf(FlatMap map) {
    return FlatLookup(std::make_shared<const FlatMap>(std::move(map)));
}

// Haustra-like: deep folds and a bend.
glm::dvec3 folded(double x, double y) {
    const double angle = 2.0 * std::numbers::pi * x;
    const double radius = 25.0 - 12.0 * std::pow(0.5 + 0.5 * std::cos(14.0 * y), 4) *
                                     (1.0 + 0.3 * std::cos(3.0 * angle));
    return {60.0 * std::sin(0.8 * y) + radius * std::cos(angle), radius * std::sin(angle),
            80.0 * y};
}

FlatMap foldedMap() {
    return flatMapOf(folded, heightUnits, 60, 200);
}
// So fine that the chords of its triangles are its arcs to 1e-5.
FlatMap cylinderMap() {
    return flatMapOf(tests::cylinder(circumferenceMm), heightUnits, 300, 80);
}

TEST(PlaceByCenterline, IsTheNearestPointOrWithoutALineThePlaceItself) {
    Centerline line;
    line.points = {{{0, 0, 0}, 0.0, 5.0, false}, {{0, 0, 10}, 10.0, 5.0, false}};
    const WallPlace place = placeByCenterline(line, {4, 0, 7});
    EXPECT_EQ(place.positionMm, glm::dvec3(4, 0, 7));
    EXPECT_NEAR(glm::distance(place.cameraMm, glm::dvec3(0, 0, place.arcMm)), 0.0, 1e-9);
    EXPECT_NEAR(place.arcMm, nearestArc(line, {4, 0, 7}), 1e-12);
    EXPECT_EQ(place.flatTriangle, -1);
    const WallPlace alone = placeByCenterline({}, {4, 0, 7});
    EXPECT_EQ(alone.cameraMm, glm::dvec3(4, 0, 7));
    EXPECT_EQ(alone.arcMm, 0.0);
}

TEST(FlatLookup, PlaceIsInTheTriangleThatItNames) {
    const FlatLookup lookup = lookupOf(foldedMap());
    const FlatMap& map = lookup.map();
    std::mt19937 random(3);
    for (int n = 0; n < 3000; ++n) {
        const glm::dvec2 flat(uniform(random, -1.0, 2.0), uniform(random, 0.0, heightUnits));
        const auto place = lookup.at(flat);
        ASSERT_TRUE(place);
        EXPECT_NEAR(turnsApart(place->flat.x, flat.x), 0.0, 1e-12);
        EXPECT_EQ(place->flat.y, flat.y);
        EXPECT_EQ(place->sourceTriangle, place->flatTriangle);
        glm::dvec2 sum(0.0);
        glm::dvec3 position(0.0);
        double weights = 0.0;
        const glm::ivec3 t = map.surface.triangles[std::size_t(place->flatTriangle)];
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(place->barycentric[c], 0.0);
            weights += place->barycentric[c];
            sum += place->barycentric[c] * map.flat[std::size_t(t[c])];
            position += place->barycentric[c] * map.surface.vertices[std::size_t(t[c])];
        }
        EXPECT_NEAR(weights, 1.0, 1e-12);
        EXPECT_NEAR(turnsApart(sum.x, flat.x), 0.0, 1e-12);
        EXPECT_NEAR(sum.y, flat.y, 1e-12);
        EXPECT_NEAR(glm::distance(position, place->positionMm), 0.0, 1e-11);
    }
}

TEST(FlatLookup, CamerasAreInterpolated) {
    const FlatLookup lookup = lookupOf(cylinderMap());
    std::mt19937 random(5);
    for (int n = 0; n < 300; ++n) {
        const glm::dvec2 flat(uniform(random, 0.0, 1.0), uniform(random, 0.0, heightUnits));
        const auto place = lookup.at(flat);
        ASSERT_TRUE(place);
        // Vertices stand up to 0.3 rows from their camera.
        EXPECT_NEAR(place->arcMm, flat.y, 0.31 * heightUnits / 80);
        EXPECT_NEAR(place->cameraMm.z, place->arcMm, 1e-12);
    }
}

TEST(FlatLookup, BothSidesOfTheSeamAreOnePlace) {
    const FlatLookup lookup = lookupOf(foldedMap());
    std::mt19937 random(7);
    for (int n = 0; n < 500; ++n) {
        const double y = uniform(random, 0.0, heightUnits);
        const glm::dvec3 zero = lookup.at({0.0, y})->positionMm;
        for (const double x : {1.0, -3.0, 1e-15, -1e-15, 1.0 - 1e-16, 7.0 + 1e-13})
            EXPECT_NEAR(glm::distance(lookup.at({x, y})->positionMm, zero), 0.0, 1e-9);
        const auto place = lookup.at({-1e-18, y});
        EXPECT_GE(place->flat.x, 0.0);
        EXPECT_LT(place->flat.x, 1.0);
    }
}

TEST(FlatLookup, NothingIsBeyondTheStrip) {
    const FlatLookup lookup = lookupOf(foldedMap());
    EXPECT_TRUE(lookup.at({0.3, 0.0}));
    EXPECT_TRUE(lookup.at({0.3, heightUnits}));
    EXPECT_FALSE(lookup.at({0.3, -1e-12}));
    EXPECT_FALSE(lookup.at({0.3, heightUnits + 1e-12}));
    EXPECT_FALSE(lookup.at({0.3, std::nan("")}));
    EXPECT_FALSE(lookup.at({std::nan(""), 0.5}));
    EXPECT_FALSE(lookup.at({INFINITY, 0.5}));
}

TEST(FlatLookup, HairlineGapsBelongToTheNearerTriangle) {
    FlatMap map = foldedMap();
    // Triangles come apart by a hair: each gets corners of its own, drawn in by 1e-9.
    FlatMap apart;
    apart.height = map.height;
    apart.cameras = map.cameras;
    apart.sourceTriangle = map.sourceTriangle;
    for (const glm::ivec3& t : map.surface.triangles) {
        glm::dvec2 middle(0.0);
        for (int c = 0; c < 3; ++c)
            middle += map.flat[std::size_t(t[c])] / 3.0;
        const int first = int(apart.flat.size());
        for (int c = 0; c < 3; ++c) {
            const glm::dvec2 corner = map.flat[std::size_t(t[c])];
            apart.flat.push_back(corner + 1e-9 * (middle - corner));
            apart.surface.vertices.push_back(map.surface.vertices[std::size_t(t[c])]);
            apart.camera.push_back(map.camera[std::size_t(t[c])]);
        }
        apart.surface.triangles.push_back({first, first + 1, first + 2});
    }
    const FlatLookup whole = lookupOf(map), cracked = lookupOf(apart);
    for (std::size_t v = 0; v < map.flat.size(); ++v) {
        const auto place = cracked.at(map.flat[v]);
        ASSERT_TRUE(place);
        EXPECT_NEAR(glm::distance(place->positionMm, map.surface.vertices[v]), 0.0, 1e-6);
    }
    const WallPath across = cracked.path({0.2, 0.1}, {1.4, 3.7});
    EXPECT_NEAR(across.lengthMm, whole.path({0.2, 0.1}, {1.4, 3.7}).lengthMm, 1e-4);
}

TEST(FlatLookup, NearestAgreesWithAllTriangles) {
    const FlatLookup lookup = lookupOf(flatMapOf(folded, heightUnits, 24, 60));
    const TriMesh& mesh = lookup.map().surface;
    std::mt19937 random(11);
    for (int n = 0; n < 400; ++n) {
        const double reach = n % 2 ? 60.0 : 400.0;
        const glm::dvec3 p(uniform(random, -reach, reach), uniform(random, -reach, reach),
                           uniform(random, -100.0, 420.0));
        double best = INFINITY;
        for (const glm::ivec3& t : mesh.triangles) {
            const glm::dvec3 a = mesh.vertices[std::size_t(t.x)],
                             b = mesh.vertices[std::size_t(t.y)],
                             c = mesh.vertices[std::size_t(t.z)];
            const glm::dvec3 w = nearestInTriangle(p, a, b, c);
            best = std::min(best, glm::distance(p, w.x * a + w.y * b + w.z * c));
        }
        EXPECT_NEAR(glm::distance(lookup.nearest(p).positionMm, p), best, 1e-9);
    }
}

// Against a triangle sampled densely: no sample is nearer, and the answer is on the triangle.
TEST(FlatLookup, NearestInTriangleIsNearest) {
    std::mt19937 random(13);
    for (int n = 0; n < 300; ++n) {
        glm::dvec3 corner[3];
        for (glm::dvec3& c : corner)
            c = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
        if (n % 5 == 0) corner[2] = glm::mix(corner[0], corner[1], 0.3);  // a segment
        if (n % 15 == 0) corner[1] = corner[2] = corner[0];
        const glm::dvec3 p(uniform(random, -2, 2), uniform(random, -2, 2), uniform(random, -2, 2));
        const glm::dvec3 w = nearestInTriangle(p, corner[0], corner[1], corner[2]);
        EXPECT_NEAR(w.x + w.y + w.z, 1.0, 1e-12);
        EXPECT_GE(std::min({w.x, w.y, w.z}), 0.0);
        const double found = glm::distance(p, w.x * corner[0] + w.y * corner[1] + w.z * corner[2]);
        constexpr int steps = 40;
        double sampled = INFINITY;
        for (int i = 0; i <= steps; ++i) {
            for (int j = 0; i + j <= steps; ++j) {
                const glm::dvec3 s = (double(i) * corner[0] + double(j) * corner[1] +
                                      double(steps - i - j) * corner[2]) /
                                     double(steps);
                sampled = std::min(sampled, glm::distance(p, s));
            }
        }
        EXPECT_LE(found, sampled + 1e-12);
        EXPECT_GE(found, sampled - 0.15);
    }
}

TEST(FlatLookup, FlatToWallAndBackIsWithinAThousandthOfAPixel) {
    const FlatLookup lookup = lookupOf(foldedMap());
    std::mt19937 random(17);
    for (int n = 0; n < 10000; ++n) {
        const glm::dvec2 flat(uniform(random, 0.0, 1.0), uniform(random, 0.0, heightUnits));
        const WallPlace back = lookup.nearest(lookup.at(flat)->positionMm);
        EXPECT_LT(1600.0 * turnsApart(back.flat.x, flat.x), 1e-3);
        EXPECT_LT(1600.0 * std::abs(back.flat.y - flat.y), 1e-3);
    }
}

TEST(FlatLookup, LinesOnACylinderHaveTheirLength) {
    const FlatLookup lookup = lookupOf(cylinderMap());
    std::mt19937 random(19);
    for (int n = 0; n < 200; ++n) {
        const glm::dvec2 from(uniform(random, -1.0, 2.0), uniform(random, 0.0, heightUnits));
        const glm::dvec2 to(uniform(random, -1.0, 2.0), uniform(random, 0.0, heightUnits));
        const WallPath path = lookup.path(from, to);
        const double length = circumferenceMm * glm::distance(from, to);
        EXPECT_NEAR(path.lengthMm, length, 1e-4 * length);
        EXPECT_NEAR(path.straightMm, glm::distance(path.pointsMm.front(), path.pointsMm.back()),
                    1e-12);
        EXPECT_NEAR(glm::distance(path.pointsMm.front(), lookup.at(from)->positionMm), 0.0, 1e-9);
        EXPECT_NEAR(glm::distance(path.pointsMm.back(), lookup.at(to)->positionMm), 0.0, 1e-9);
    }
}

TEST(FlatLookup, LinesAlongEdgesSeamAndRimsHaveTheirLength) {
    const FlatLookup lookup = lookupOf(cylinderMap());
    const FlatMap& map = lookup.map();
    const auto expectLength = [&](glm::dvec2 from, glm::dvec2 to) {
        const double length = circumferenceMm * glm::distance(from, to);
        EXPECT_NEAR(lookup.path(from, to).lengthMm, length, 1e-4 * length + 1e-9);
    };
    expectLength({0.0, 0.0}, {0.0, heightUnits});
    expectLength({1.0, 0.5}, {1.0, heightUnits});
    expectLength({0.0, 0.0}, {1.0, 0.0});
    expectLength({1.3, heightUnits}, {-1.0, heightUnits});
    expectLength({0.4, 1.0}, {0.4, 1.0});
    for (std::size_t t = 0; t < map.surface.triangles.size(); t += 97) {
        const glm::ivec3 v = map.surface.triangles[t];
        expectLength(map.flat[std::size_t(v.x)], map.flat[std::size_t(v.y)]);
    }
}

TEST(FlatLookup, PathStaysOnTheWallAndIsClampedToTheStrip) {
    const FlatLookup lookup = lookupOf(foldedMap());
    const WallPath path = lookup.path({0.2, -3.0}, {0.9, 99.0});
    const WallPath clamped = lookup.path({0.2, 0.0}, {0.9, heightUnits});
    EXPECT_EQ(path.lengthMm, clamped.lengthMm);
    double length = 0.0;
    for (std::size_t n = 0; n < path.pointsMm.size(); ++n) {
        const glm::dvec3 p = path.pointsMm[n];
        EXPECT_NEAR(glm::distance(lookup.nearest(p).positionMm, p), 0.0, 1e-9);
        if (n > 0) length += glm::distance(path.pointsMm[n - 1], p);
    }
    EXPECT_NEAR(path.lengthMm, length, 1e-9 * length);
    // Dense sampling of the same line agrees from below.
    double sampled = 0.0;
    glm::dvec3 last = clamped.pointsMm.front();
    for (int n = 1; n <= 20000; ++n) {
        const double t = n / 20000.0;
        const glm::dvec3 p = lookup.at({0.2 + 0.7 * t, heightUnits * t})->positionMm;
        sampled += glm::distance(last, p);
        last = p;
    }
    EXPECT_GE(path.lengthMm, sampled - 1e-6);
    EXPECT_NEAR(path.lengthMm, sampled, 1e-3 * length);
}

TEST(FlatLookup, RectanglesOnACylinderHaveTheirArea) {
    const FlatLookup lookup = lookupOf(cylinderMap());
    std::mt19937 random(23);
    for (int n = 0; n < 100; ++n) {
        const glm::dvec2 low(uniform(random, -1.5, 1.5), uniform(random, 0.0, 3.0));
        const glm::dvec2 size(uniform(random, 0.001, 0.9), uniform(random, 0.001, 0.9));
        const double area = circumferenceMm * circumferenceMm * size.x * size.y;
        const std::vector<glm::dvec2> corners{
            low, {low.x + size.x, low.y}, low + size, {low.x, low.y + size.y}};
        EXPECT_NEAR(lookup.areaMm2(corners), area, 1e-4 * area);
        EXPECT_NEAR(lookup.areaMm2({corners.rbegin(), corners.rend()}), area, 1e-4 * area);
    }
}

TEST(FlatLookup, PolygonsOfAnyShapeHaveTheirArea) {
    const FlatLookup lookup = lookupOf(cylinderMap());
    const double unit = circumferenceMm * circumferenceMm;
    EXPECT_EQ(lookup.areaMm2({}), 0.0);
    EXPECT_EQ(lookup.areaMm2({{0.1, 1.0}}), 0.0);
    EXPECT_NEAR(lookup.areaMm2({{0.1, 1.0}, {0.3, 2.0}}), 0.0, 1e-9);
    // A star with a hollow middle by the even-odd rule: five points and the pentagon between them.
    std::vector<glm::dvec2> star;
    for (int n = 0; n < 5; ++n) {
        const double angle = 4.0 * std::numbers::pi * n / 5.0;
        star.push_back(glm::dvec2(0.95, 1.7) + 0.3 * glm::dvec2(std::sin(angle), std::cos(angle)));
    }
    const double tip = std::tan(0.1 * std::numbers::pi);  // of half a point's angle
    const double inner = 0.3 * std::cos(0.4 * std::numbers::pi) / std::cos(0.2 * std::numbers::pi);
    const double side = 2.0 * inner * std::sin(0.2 * std::numbers::pi);
    EXPECT_NEAR(lookup.areaMm2(star), unit * 5.0 * 0.25 * side * side / tip, 1e-4 * unit * 0.05);
    // Two triangles that meet where the polygon crosses itself.
    EXPECT_NEAR(lookup.areaMm2({{0.2, 1.0}, {0.6, 1.4}, {0.6, 1.0}, {0.2, 1.4}}), unit * 2.0 * 0.04,
                1e-4 * unit * 0.08);
    // A circle, half of it beyond the strip.
    std::vector<glm::dvec2> circle;
    for (int n = 0; n < 400; ++n) {
        const double angle = 2.0 * std::numbers::pi * n / 400.0;
        circle.push_back(glm::dvec2(0.1, 0.0) + 0.2 * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    const double half = 0.5 * std::numbers::pi * 0.04 * unit;
    EXPECT_NEAR(lookup.areaMm2(circle), half, 2e-4 * half);
}

TEST(FlatLookup, NothingIsMeasuredWhereNothingCanBe) {
    const FlatLookup lookup = lookupOf(foldedMap());
    const double beyond = FlatLookup::mostTurns + 1.0;
    for (const glm::dvec2 end :
         {glm::dvec2(NAN, 1.0), {0.5, NAN}, {INFINITY, 1.0}, {beyond, 1.0}}) {
        EXPECT_TRUE(lookup.path({0.0, 1.0}, end).pointsMm.empty());
        EXPECT_TRUE(lookup.path(end, {0.0, 1.0}).pointsMm.empty());
        EXPECT_EQ(lookup.areaMm2({{0.0, 1.0}, end, {0.3, 2.0}}), 0.0);
    }
    // Far away is not wide.
    const double away = 1e6;
    EXPECT_NEAR(lookup.path({away, 1.0}, {away + 0.4, 2.0}).lengthMm,
                lookup.path({0.0, 1.0}, {0.4, 2.0}).lengthMm, 1e-6);
    EXPECT_NEAR(lookup.areaMm2({{away, 1.0}, {away + 0.4, 1.0}, {away, 2.0}}),
                lookup.areaMm2({{0.0, 1.0}, {0.4, 1.0}, {0.0, 2.0}}), 1e-4);
}

TEST(FlatLookup, WholeStripIsTheWholeSurface) {
    const FlatLookup lookup = lookupOf(foldedMap());
    double area = 0.0;
    for (const glm::ivec3& t : lookup.map().surface.triangles) {
        const auto& v = lookup.map().surface.vertices;
        area += 0.5 * glm::length(glm::cross(v[std::size_t(t.y)] - v[std::size_t(t.x)],
                                             v[std::size_t(t.z)] - v[std::size_t(t.x)]));
    }
    EXPECT_NEAR(lookup.areaMm2({{0.37, -1.0}, {1.37, -1.0}, {1.37, 9.0}, {0.37, 9.0}}), area,
                1e-9 * area);
}

// Half a ball, 10 mm across, over the seam. Clicked on its foot from any side, to the pixel of a
// 400-pixel strip, it reads 10 mm.
TEST(FlatLookup, PolypReadsItsDiameterAndArea) {
    const tests::HalfBall polyp;
    const FlatLookup lookup = lookupOf(
        flatMapOf([&](double x, double y) { return polyp.position(x, y); }, 1.0, 400, 400));
    const auto toPixel = [](glm::dvec2 v) { return (glm::floor(400.0 * v) + 0.5) / 400.0; };
    std::vector<glm::dvec2> outline;
    for (int n = 0; n < 72; ++n) {
        const double azimuth = std::numbers::pi * n / 36.0;
        outline.push_back(polyp.foot(azimuth));
        const WallPath path = lookup.path(toPixel(polyp.foot(azimuth)),
                                          toPixel(polyp.foot(azimuth + std::numbers::pi)));
        EXPECT_NEAR(path.straightMm, 2.0 * polyp.ballMm, 0.5);
        EXPECT_GT(path.lengthMm, 14.0);  // over the top
    }
    EXPECT_NEAR(lookup.areaMm2(outline), polyp.areaMm2(), 0.02 * polyp.areaMm2());
}

}  // namespace
}  // namespace haustra
