// What cameras show of a wall, by rays through the scan itself; and the paint that tells it.
#include "render/wall/wall_coverage.h"

#include "flat_tube.h"
#include "render/wall/strip_painter.h"

#include <set>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using namespace render;

class WallCoverageTest : public ::testing::Test {
protected:
    static std::shared_ptr<const WallSight> sightOf(const FlatMap& map) {
        auto made = WallSight::of(std::make_shared<const FlatMap>(map));
        if (!made) throw std::runtime_error(describe(made.error()));
        return *made;
    }
    static Camera onAxis(double z, double towards = 1.0) {
        return {{0.0, 0.0, z}, {0.0, 0.0, towards}, {0.0, -1.0, 0.0}, 90.0};
    }
    glm::dvec3 middle(int triangle) const {
        return sight->originMm() + glm::dvec3(sight->facets()[std::size_t(triangle)].middleMm);
    }

    const FlatTube tube{{.leanMm = 4.0}};
    const FlatMap map = tube.map({60, 100});
    const std::shared_ptr<const WallSight> sight = sightOf(map);
    const int triangles = int(map.surface.triangles.size());
};

double interpolated(const Volume<std::int16_t>& scan, glm::dvec3 at) {
    const glm::dvec3 voxel = scan.grid().voxelFromPatientPoint(at);
    const glm::ivec3 size = scan.grid().size;
    const glm::ivec3 low = glm::clamp(glm::ivec3(glm::floor(voxel)), glm::ivec3(0), size - 2);
    const glm::dvec3 part = voxel - glm::dvec3(low);
    double value = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 weights = glm::mix(1.0 - part, part, glm::dvec3(step));
        const glm::ivec3 v = low + step;
        value += weights.x * weights.y * weights.z *
                 scan.voxels()[std::size_t(v.x + size.x * (v.y + size.y * v.z))];
    }
    return value;
}

TEST_F(WallCoverageTest, SeesWhatARayThroughTheScanReaches) {
    const auto scan = tube.scan(0.5);
    constexpr double stepMm = 0.1;
    int shown = 0, hidden = 0, differ = 0, outside = 0;
    for (const double z : {6.0, 21.0, 40.0}) {
        for (const double towards : {1.0, -1.0}) {
            WallCoverage coverage(sight);
            const Camera camera = onAxis(z, towards);
            coverage.show(camera, {512, 512});
            for (int t = 0; t < triangles; ++t) {
                const glm::dvec3 from = camera.positionMm, way = middle(t) - from;
                const double distance = glm::length(way);
                const glm::dvec3 along = way / distance;
                const double facing =
                    -glm::dot(along, glm::dvec3(sight->facets()[std::size_t(t)].inward));
                const double depth = towards * way.z;
                const bool inPicture =
                    depth > 0.0 && std::max(std::abs(way.x), std::abs(way.y)) < depth;
                if (!inPicture || facing < std::cos(glm::radians(seenLimits.mostAngleDegrees)) ||
                    distance < seenLimits.nearestMm || distance > seenLimits.farthestMm) {
                    outside += coverage.seen(t);
                    continue;
                }
                // Tissue well before the place; a scan's edge is a millimetre wide.
                double densest = -1000.0;
                for (double at = 0.0; at < distance - 1.5; at += stepMm)
                    densest = std::max(densest, interpolated(scan, from + at * along));
                if (densest > -700.0 && densest < -250.0) continue;  // it passes a crest
                (densest < -480.0 ? shown : hidden)++;
                differ += coverage.seen(t) != (densest < -480.0);
            }
        }
    }
    EXPECT_EQ(outside, 0);
    EXPECT_GT(shown, 2000);
    EXPECT_GT(hidden, 1000);
    EXPECT_LE(differ, (shown + hidden) / 100);
}

TEST_F(WallCoverageTest, TheShareGrowsFromNothingToAllAndIsOfArea) {
    WallCoverage coverage(sight);
    EXPECT_EQ(coverage.share(), 0.0);
    double before = 0.0;
    const auto areaSeen = [&] {
        double seen = 0.0;
        for (int t = 0; t < triangles; ++t)
            if (coverage.seen(t)) seen += sight->facets()[std::size_t(t)].areaMm2;
        return seen / sight->areaMm2();
    };
    for (double z = 1.0; z < 60.0; z += 3.0) {
        coverage.show(onAxis(z), {512, 512});
        EXPECT_GE(coverage.share(), before);
        before = coverage.share();
        EXPECT_NEAR(before, areaSeen(), 1e-6);
    }
    EXPECT_GT(before, 0.3);
    EXPECT_EQ(coverage.show(onAxis(58.0), {512, 512}), 0) << "the same camera twice";
    for (double z = 1.0; z < 60.0; z += 3.0)
        coverage.show(onAxis(z, -1.0), {512, 512});
    // The folds overhang: flying both ways along the axis is not enough.
    EXPECT_GT(coverage.share(), before + 0.05);
    EXPECT_LT(coverage.share(), 0.99);
    for (int t = 0; t < triangles; ++t) {
        const glm::dvec3 inward(sight->facets()[std::size_t(t)].inward);
        const glm::dvec3 up = std::abs(inward.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        coverage.show({middle(t) + 3.2 * inward, -inward, up, 90.0}, {512, 512});
    }
    EXPECT_EQ(coverage.share(), 1.0);
    coverage.forget();
    EXPECT_EQ(coverage.share(), 0.0);
    EXPECT_GT(coverage.show(onAxis(10.0), {512, 512}), 0);
}

TEST_F(WallCoverageTest, LensesShowWhatIsInTheirPictures) {
    const auto share = [&](Camera camera, glm::ivec2 size = {512, 512}) {
        WallCoverage coverage(sight);
        coverage.show(camera, size);
        return coverage.share();
    };
    const Camera forward = onAxis(30.0);
    Camera narrow = forward, fisheye = forward, parallel = forward;
    narrow.fovDegrees = 40.0;
    fisheye.lens = Lens::fisheye;
    fisheye.fovDegrees = 360.0;
    parallel.lens = Lens::orthographic;
    parallel.heightMm = 60.0;
    EXPECT_LT(share(narrow), share(forward));
    // All around is at least what two cameras see, back to back.
    EXPECT_GT(share(fisheye), share(forward) + share(onAxis(30.0, -1.0)));
    EXPECT_GT(share(parallel), 0.0);
    EXPECT_EQ(share(forward, {4, 4}), 0.0) << "pixels of centimetres";
    // From outside, the wall is seen from behind.
    EXPECT_EQ(share({{60.0, 0.0, 30.0}, {-1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 90.0}), 0.0);
}

TEST_F(WallCoverageTest, RaysMeetTheWallWhereTheMapHasIt) {
    for (const double angle : {0.1, 1.0, 3.0, 6.2}) {
        const glm::dvec3 across(std::cos(angle), std::sin(angle), 0.0);
        const auto met = sight->firstMet({0.0, 0.0, 22.0}, 3.0 * across);
        ASSERT_TRUE(met);
        EXPECT_NEAR(met->flat.x, angle / (2.0 * std::numbers::pi), 1e-3);
        EXPECT_LT(glm::distance(tube.positionMm(met->flat), met->positionMm), 0.2);
        EXPECT_NEAR(met->distanceMm, std::hypot(met->positionMm.x, met->positionMm.y), 1e-4);
    }
    EXPECT_FALSE(sight->firstMet({0.0, 0.0, 30.0}, {0.0, 0.0, 1.0})) << "open at its ends";
}

class StripPainterTest : public WallCoverageTest {
protected:
    static std::shared_ptr<const StripPainter> painterOf(std::shared_ptr<const WallSight> sight) {
        auto made = StripPainter::of(std::move(sight));
        if (!made) throw std::runtime_error(describe(made.error()));
        return *made;
    }
};

TEST_F(StripPainterTest, DiscsHoldWhatIsWithinTheRadiusAcrossTheSeamToo) {
    const FlatTube plain{{.foldMm = 0.0}};
    const auto painter = painterOf(sightOf(plain.map({240, 120})));
    for (const glm::dvec2 flat : {glm::dvec2(0.5, 0.3), {0.001, 0.4}, {0.7, 0.01}}) {
        const WallMark mark{flat, plain.positionMm(flat)};
        constexpr double radius = 6.0;
        std::set<std::int32_t> marked;
        for (const MarkedPixel& pixel : painter->discs({&mark, 1}, radius)) {
            marked.insert(pixel.pixel);
            EXPECT_GT(pixel.cover, 0);
        }
        const glm::ivec2 size = painter->size();
        int wrong = 0, inside = 0;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const glm::dvec2 at = (glm::dvec2(size) - glm::dvec2(x, y) - 0.5) / double(size.x);
                if (at.y > plain.height()) continue;
                const double distance = glm::distance(plain.positionMm(at), mark.positionMm);
                inside += distance <= radius;
                // The map's facets lie a little within the tube.
                if (std::abs(distance - radius) > 0.1)
                    wrong += marked.contains(y * size.x + x) != (distance < radius);
            }
        }
        EXPECT_EQ(wrong, 0);
        EXPECT_GT(inside, 300);
    }
    EXPECT_TRUE(painter->discs({}, 5.0).empty());
}

TEST_F(StripPainterTest, WhatHasNotBeenSeenHasAColourAndMarksLieOverIt) {
    const auto painter = painterOf(sight);
    WallCoverage coverage(sight);
    coverage.show(onAxis(20.0), {512, 512});
    const auto paint = painter->paint({}, coverage.seenTriangles());
    ASSERT_TRUE(checkWallPaint(*paint));
    int seen = 0, unseen = 0;
    for (int t = 0; t < triangles; ++t) {
        // A pixel of the strip lies well within a triangle, or not; look in its middle.
        glm::dvec2 flat(0.0);
        for (int corner = 0; corner < 3; ++corner)
            flat += map.flat[std::size_t(map.surface.triangles[std::size_t(t)][corner])] / 3.0;
        const glm::u8vec4 color = paint->at(flat);
        // All triangles around it are alike, so that smoothing leaves its middle alone.
        if (color.a != 0 && color.a != 150) continue;
        EXPECT_EQ(color.a == 0, coverage.seen(t));
        (coverage.seen(t) ? seen : unseen)++;
    }
    EXPECT_GT(seen, 500);
    EXPECT_GT(unseen, 500);
    EXPECT_EQ(painter->paint({}, {})->at({0.5, 0.5}), glm::u8vec4(0));

    const glm::dvec2 flat(0.5, 0.5);
    const WallMark mark{flat, tube.positionMm(flat)};
    const auto both = painter->paint(painter->discs({&mark, 1}, 5.0), coverage.seenTriangles());
    EXPECT_GT(both->at(flat).r, both->at(flat).b) << "a mark is yellow";
    EXPECT_EQ(both->at({0.0, 0.9}), paint->at({0.0, 0.9}));
}

// A stretch of the tube, from 20 to 26 mm, that is no wall.
class BridgedWallTest : public StripPainterTest {
protected:
    static bool isBridged(double z) { return z > 20.0 && z < 26.0; }
    std::vector<std::uint8_t> bridged() const {
        std::vector<std::uint8_t> marks;
        for (int t = 0; t < triangles; ++t)
            marks.push_back(isBridged(middle(t).z));
        return marks;
    }
    std::shared_ptr<const WallSight> bridgedSight() const {
        auto made = WallSight::of(std::make_shared<const FlatMap>(map), bridged());
        if (!made) throw std::runtime_error(describe(made.error()));
        return *made;
    }
};

TEST_F(BridgedWallTest, ABridgeIsNeverSeenAndNoPartOfTheWallsArea) {
    const auto withBridge = bridgedSight();
    double bridgeMm2 = 0.0;
    for (int t = 0; t < triangles; ++t)
        if (isBridged(middle(t).z)) bridgeMm2 += sight->facets()[std::size_t(t)].areaMm2;
    EXPECT_NEAR(withBridge->areaMm2() + bridgeMm2, sight->areaMm2(), 1e-3);
    WallCoverage coverage(withBridge), plain(sight);
    for (double z = 1.0; z < 60.0; z += 3.0) {
        coverage.show(onAxis(z), {512, 512});
        plain.show(onAxis(z), {512, 512});
    }
    double seenMm2 = 0.0;
    for (int t = 0; t < triangles; ++t) {
        EXPECT_EQ(coverage.seen(t), plain.seen(t) && !isBridged(middle(t).z));
        if (coverage.seen(t)) seenMm2 += sight->facets()[std::size_t(t)].areaMm2;
    }
    EXPECT_NEAR(coverage.share(), seenMm2 / withBridge->areaMm2(), 1e-6);
    for (int t = 0; t < triangles; ++t) {
        const glm::dvec3 inward(sight->facets()[std::size_t(t)].inward);
        const glm::dvec3 up = std::abs(inward.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        coverage.show({middle(t) + 3.2 * inward, -inward, up, 90.0}, {512, 512});
    }
    EXPECT_EQ(coverage.share(), 1.0) << "all of the wall that there is";
}

TEST_F(BridgedWallTest, ABridgeIsHatchedAndNothingElseIs) {
    const auto painter = painterOf(bridgedSight());
    const std::vector<std::uint8_t> none(std::size_t(triangles), 0), all(std::size_t(triangles), 1);
    WallPaint given;
    given.size = {1, 1};
    given.height = painter->paint({}, {})->height;
    given.pixels = {{255, 0, 0, 255}};
    std::set<int> greys;
    for (const auto& paint : {painter->paint({}, {}), painter->paint({}, none),
                              painter->paint({}, all), painter->bridgesOver(given)}) {
        ASSERT_TRUE(checkWallPaint(*paint));
        int hatched = 0;
        for (int y = 0; y < paint->size.y; ++y) {
            for (int x = 0; x < paint->size.x; ++x) {
                const glm::dvec2 flat =
                    (glm::dvec2(paint->size) - glm::dvec2(x, y) - 0.5) / double(paint->size.x);
                if (flat.y > map.height) continue;
                const glm::u8vec4 color =
                    paint->pixels[std::size_t(y) * std::size_t(paint->size.x) + std::size_t(x)];
                const bool grey = color.a == 255 && color.r == color.g && color.g == color.b;
                const double z = tube.positionMm(flat).z;
                // Of triangles across the bridge's ends, the middle decides.
                if (std::min(std::abs(z - 20.0), std::abs(z - 26.0)) < 1.0) continue;
                EXPECT_EQ(grey, isBridged(z)) << "at " << z << " mm";
                hatched += grey;
                if (grey) greys.insert(color.r);
            }
        }
        EXPECT_GT(hatched, 1000);
    }
    EXPECT_EQ(greys.size(), 2u) << "stripes of two greys";
}

TEST_F(BridgedWallTest, MarksOfAnotherMapAreRefused) {
    EXPECT_FALSE(WallSight::of(std::make_shared<const FlatMap>(map), {1, 0, 1}));
}

}  // namespace
}  // namespace haustra::tests
