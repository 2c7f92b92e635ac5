// What cameras show of a wall, by rays through the scan itself; and the paint that tells it.
#include "render/wall/wall_coverage.h"

#include "flat_tube.h"
#include "render/optics/drawn_wall.h"
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
    /// Whatever is shown is seen, unless it is smaller than a pixel of 2 mm.
    static constexpr SeenLimits atOnce{0.5, 0};
    static int show(WallCoverage& coverage, const Camera& camera, glm::ivec2 size = {512, 512}) {
        return coverage.show(camera, size, 1000);
    }
    static bool isShown(const WallCoverage& coverage, int triangle) {
        return coverage.times()[std::size_t(triangle)] >= coverage.enough();
    }
    double areaMm2(const std::vector<std::uint8_t>& which) const {
        double sum = 0.0;
        for (int t = 0; t < triangles; ++t)
            if (which[std::size_t(t)]) sum += sight->facets()[std::size_t(t)].areaMm2;
        return sum;
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
            WallCoverage coverage(sight, atOnce);
            const Camera camera = onAxis(z, towards);
            show(coverage, camera);
            for (int t = 0; t < triangles; ++t) {
                const glm::dvec3 from = camera.positionMm, way = middle(t) - from;
                const double distance = glm::length(way);
                const glm::dvec3 along = way / distance;
                const double facing =
                    -glm::dot(along, glm::dvec3(sight->facets()[std::size_t(t)].inward));
                const double depth = towards * way.z;
                const bool inPicture =
                    depth > 0.0 && std::max(std::abs(way.x), std::abs(way.y)) < depth;
                if (!inPicture || facing < std::cos(glm::radians(sightLimits.mostAngleDegrees)) ||
                    distance < sightLimits.nearestMm || distance > sightLimits.farthestMm) {
                    outside += isShown(coverage, t);
                    continue;
                }
                // Tissue well before the place; a scan's edge is a millimetre wide.
                double densest = -1000.0;
                for (double at = 0.0; at < distance - 1.5; at += stepMm)
                    densest = std::max(densest, interpolated(scan, from + at * along));
                if (densest > -700.0 && densest < -250.0) continue;  // it passes a crest
                (densest < -480.0 ? shown : hidden)++;
                differ += isShown(coverage, t) != (densest < -480.0);
            }
        }
    }
    EXPECT_EQ(outside, 0);
    EXPECT_GT(shown, 2000);
    EXPECT_GT(hidden, 1000);
    EXPECT_LE(differ, (shown + hidden) / 100);
}

TEST_F(WallCoverageTest, TheShareGrowsFromNothingToAllAndIsOfArea) {
    WallCoverage coverage(sight, atOnce);
    EXPECT_EQ(coverage.share(), 0.0);
    double before = 0.0;
    const auto areaSeen = [&] { return areaMm2(coverage.seenTriangles()) / sight->areaMm2(); };
    for (double z = 1.0; z < 60.0; z += 3.0) {
        show(coverage, onAxis(z));
        EXPECT_GE(coverage.share(), before);
        before = coverage.share();
        EXPECT_NEAR(before, areaSeen(), 1e-6);
    }
    EXPECT_GT(before, 0.3);
    EXPECT_EQ(show(coverage, onAxis(58.0)), 0) << "the same camera twice";
    for (double z = 1.0; z < 60.0; z += 3.0)
        show(coverage, onAxis(z, -1.0));
    // The folds overhang: flying both ways along the axis is not enough.
    EXPECT_GT(coverage.share(), before + 0.05);
    EXPECT_LT(coverage.share(), 0.99);
    for (int t = 0; t < triangles; ++t) {
        const glm::dvec3 inward(sight->facets()[std::size_t(t)].inward);
        const glm::dvec3 up = std::abs(inward.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        show(coverage, {middle(t) + 3.2 * inward, -inward, up, 90.0});
    }
    EXPECT_EQ(coverage.share(), 1.0);
    coverage.forget();
    EXPECT_EQ(coverage.share(), 0.0);
    EXPECT_GT(show(coverage, onAxis(10.0)), 0);
}

TEST_F(WallCoverageTest, LensesShowWhatIsInTheirPictures) {
    const auto share = [&](Camera camera, glm::ivec2 size = {512, 512}) {
        WallCoverage coverage(sight, atOnce);
        show(coverage, camera, size);
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

TEST_F(WallCoverageTest, APlaceIsSeenOnceItHasBeenOnScreenForLongEnough) {
    WallCoverage coverage(sight, {0.5, 300});
    WallCoverage glimpse(sight, atOnce);
    show(glimpse, onAxis(20.0));
    // In parts, with other pictures between, and of the same picture again.
    for (const int ms : {100, 150, 49})
        EXPECT_GT(coverage.show(onAxis(20.0), {512, 512}, 1000 * ms), 0);
    EXPECT_EQ(coverage.share(), 0.0);
    coverage.show(onAxis(55.0), {512, 512}, 299'999);
    EXPECT_LT(coverage.share(), glimpse.share()) << "what both show alone";
    coverage.show(onAxis(20.0), {512, 512}, 1000);
    for (int t = 0; t < triangles; ++t)
        EXPECT_LE(isShown(glimpse, t), isShown(coverage, t));
    EXPECT_EQ(coverage.show(onAxis(20.0), {512, 512}, 1'000'000), 0) << "all of it has been seen";
}

TEST_F(WallCoverageTest, SmallerThanWasChosenIsNotSeen) {
    const auto share = [&](double pixelsPerMm, int side) {
        WallCoverage coverage(sight, {pixelsPerMm, 0});
        for (double z = 3.0; z < 60.0; z += 3.0)
            show(coverage, onAxis(z), {side, side});
        return coverage.share();
    };
    // Twice the pixels for twice as many a millimetre are the same.
    EXPECT_EQ(share(1.0, 64), share(8.0, 512));
    EXPECT_GT(share(1.0, 64), share(4.0, 64) + 0.05);
    EXPECT_EQ(share(100.0, 64), 0.0);
    // From 3 mm on, where 64 pixels of 90° are 10.7 a millimetre.
    EXPECT_EQ(share(11.0, 64), 0.0);
}

TEST_F(WallCoverageTest, AStripShowsWhatLiesInItLargeEnough) {
    const auto windowed = [&](const FlatWindow& window, glm::ivec2 size, double pixelsPerMm) {
        WallCoverage coverage(sight, {pixelsPerMm, 0});
        coverage.show(window, size, 1000);
        return coverage.shownTriangles();
    };
    const auto middleFlat = [&](int t) {
        glm::dvec2 flat(0.0);
        for (int corner = 0; corner < 3; ++corner)
            flat += map.flat[std::size_t(map.surface.triangles[std::size_t(t)][corner])] / 3.0;
        return flat;
    };
    // Across the seam, a quarter of the circumference to either side.
    const FlatWindow window{{0.1, 0.4}, 400.0};
    const glm::ivec2 size(200, 120);
    const auto shown = windowed(window, size, 1e-2);
    int inside = 0;
    for (int t = 0; t < triangles; ++t) {
        bool in = false;
        for (const double turn : {-1.0, 0.0, 1.0}) {
            const glm::dvec2 pixel =
                window.pixelFromFlat(middleFlat(t) + glm::dvec2(turn, 0.0), size);
            in |= pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x <= size.x && pixel.y <= size.y;
        }
        EXPECT_EQ(bool(shown[std::size_t(t)]), in) << t;
        inside += in;
    }
    EXPECT_GT(inside, 500);
    // The map is conformal: a millimetre of a ring of radius r is 1 / 2πr circumferences.
    const double pixelsPerMm = 5.0;
    const auto large = windowed({{0.5, 0.5 * map.height}, 400.0}, {2000, 2000}, pixelsPerMm);
    int some = 0, differ = 0;
    for (int t = 0; t < triangles; ++t) {
        const double radius = std::hypot(middle(t).x, middle(t).y),
                     here = 400.0 / (2.0 * std::numbers::pi * radius);
        if (std::abs(here / pixelsPerMm - 1.0) > 0.05)
            differ += large[std::size_t(t)] != (here > pixelsPerMm);
        some += large[std::size_t(t)];
    }
    EXPECT_EQ(differ, 0);
    EXPECT_GT(some, triangles / 10);
    EXPECT_LT(some, triangles * 9 / 10);
    WallCoverage whole(sight, {0.5, 0});
    whole.show(WholeStrip{}, {400, 800}, 1'000'000);
    EXPECT_EQ(whole.share(), 1.0);
    whole.forget();
    whole.show(SliceView{}, {400, 800}, 1'000'000);
    EXPECT_EQ(whole.share(), 0.0) << "a slice is no picture of the wall";
}

TEST_F(WallCoverageTest, AStripIsReadNoFasterThanTheEyeWanders) {
    // Four fields of the eye take four times as long.
    const glm::ivec2 size(400, 350);
    ASSERT_EQ(std::int64_t(size.x) * size.y, 4 * eyeFieldPixels);
    WallCoverage coverage(sight, {0.1, 300});
    coverage.show(WholeStrip{}, size, 1'199'000);
    EXPECT_EQ(coverage.share(), 0.0);
    coverage.show(WholeStrip{}, size, 1'000);
    EXPECT_EQ(coverage.share(), 1.0);
    // What is smaller than a field is read in a fixation.
    WallCoverage small(sight, {0.1, 300});
    small.show(WholeStrip{}, {100, 200}, 300'000);
    EXPECT_EQ(small.share(), 1.0);
}

TEST_F(WallCoverageTest, WhatWasKeptIsAdded) {
    WallCoverage before(sight, {0.5, 300}), after(sight, {0.5, 300}), both(sight, {0.5, 300});
    before.show(onAxis(20.0), {512, 512}, 200'000);
    after.show(onAxis(21.0), {512, 512}, 200'000);
    both.show(onAxis(20.0), {512, 512}, 200'000);
    both.show(onAxis(21.0), {512, 512}, 200'000);
    after.add(before.times());
    EXPECT_EQ(after.times(), both.times());
    EXPECT_GT(after.share(), 0.0);
}

TEST_F(WallCoverageTest, ASingleTriangleBetweenSeenOnesCounts) {
    WallCoverage coverage(sight, atOnce);
    std::vector<std::uint32_t> times(std::size_t(triangles), 1);
    // One alone, two that join each other, one on the seam.
    const auto pair = sight->neighbours()[2000];
    const int second = std::max({pair.x, pair.y, pair.z});
    const int seam = int(std::find_if(sight->facets().begin(), sight->facets().end(),
                                      [](const auto& facet) { return facet.flat.x > 0.99f; }) -
                         sight->facets().begin()) +
                     120 * 40;
    for (const int t : {500, 2000, second, seam})
        times[std::size_t(t)] = 0;
    coverage.add(times);
    const auto seen = coverage.seenTriangles();
    EXPECT_TRUE(seen[500]);
    EXPECT_FALSE(seen[2000]);
    EXPECT_FALSE(seen[std::size_t(second)]);
    EXPECT_TRUE(seen[std::size_t(seam)]);
    EXPECT_FALSE(coverage.shownTriangles()[500]);
    EXPECT_NEAR(coverage.share(), areaMm2(seen) / sight->areaMm2(), 1e-6);
}

// Those of the built-in looks that show the wall, by what their descriptions say of it.
TEST(DrawnWall, OpticsShowTheWallOrLetTheEyeThrough) {
    const std::set<std::string> opaque{"mucosa", "surface", "skin"};
    for (const std::string& name : opticsPresets()) {
        if (name.starts_with("bonsai") || name.starts_with("engine") || name.starts_with("head"))
            continue;  // not of a CT
        EXPECT_EQ(drawsWall(*opticsPreset(name)), opaque.contains(name)) << name;
    }
    Optics optics = *opticsPreset("mucosa");
    const auto with = [&](const auto& change) {
        Optics changed = optics;
        change(changed);
        return drawsWall(changed);
    };
    EXPECT_FALSE(with([](Optics& o) { o.shading = false; }));
    EXPECT_FALSE(with([](Optics& o) { o.light.diffuse = 0.0; }));
    EXPECT_FALSE(with([](Optics& o) { o.light.halfDepthMm = 0.1; }));
    EXPECT_FALSE(with([](Optics& o) { o.composition = Composition::maximumIntensity; }));
    EXPECT_TRUE(with([](Optics& o) { o.composition = Composition::firstHit; }));
    EXPECT_FALSE(with([](Optics& o) {
        for (auto& point : o.transferFunction.points)
            point.color = glm::dvec3(0.02);
    }));
    EXPECT_FALSE(with([](Optics& o) {
        for (auto& point : o.transferFunction.points)
            point.opacity *= 0.3;
    }));
    // Fog in the gas.
    EXPECT_FALSE(with([](Optics& o) {
        o.transferFunction.points.front().hu = -1001.0;
        o.transferFunction.points.front().opacity = 0.2;
    }));
    // A row of a 2-D function that the wall's steepness meets, and one that it does not.
    const auto rowAt = [&](double gradient) {
        return with([&](Optics& o) {
            o.preIntegrated = false;
            o.transferFunction.rows = {{gradient, o.transferFunction.points}};
            for (auto& point : o.transferFunction.points)
                point.opacity = 0.0;
        });
    };
    EXPECT_TRUE(rowAt(100.0));
    EXPECT_FALSE(rowAt(5000.0));
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
    WallCoverage coverage(sight, atOnce);
    show(coverage, onAxis(20.0));
    const auto counted = coverage.seenTriangles();
    const auto paint = painter->paint({}, counted);
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
        EXPECT_EQ(color.a == 0, counted[std::size_t(t)] != 0);
        (counted[std::size_t(t)] ? seen : unseen)++;
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
    WallCoverage coverage(withBridge, atOnce), plain(sight, atOnce);
    for (double z = 1.0; z < 60.0; z += 3.0) {
        show(coverage, onAxis(z));
        show(plain, onAxis(z));
    }
    for (int t = 0; t < triangles; ++t)
        EXPECT_EQ(isShown(coverage, t), isShown(plain, t) && !isBridged(middle(t).z));
    EXPECT_NEAR(coverage.share(), areaMm2(coverage.seenTriangles()) / withBridge->areaMm2(), 1e-6);
    for (int t = 0; t < triangles; ++t) {
        const glm::dvec3 inward(sight->facets()[std::size_t(t)].inward);
        const glm::dvec3 up = std::abs(inward.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        show(coverage, {middle(t) + 3.2 * inward, -inward, up, 90.0});
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
