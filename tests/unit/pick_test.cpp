// What a click in the endoscopic view means: rays through a picture, and the wall that they meet,
// found in three ways that must agree.
#include "flat_tube.h"
#include "reader/flight.h"
#include "render/scene/lens.h"
#include "session/case_questions.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace haustra::session {
namespace {

/// Unit, orthogonal directions.
Camera randomCamera(std::mt19937& random, Lens lens) {
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    const auto vector = [&] { return glm::dvec3(part(random), part(random), part(random)); };
    Camera camera{20.0 * vector(), glm::normalize(vector() + glm::dvec3(0, 0, 1.5)), {}};
    camera.up = glm::normalize(glm::cross(camera.forward, vector()));
    camera.lens = lens;
    camera.fovDegrees =
        lens == Lens::fisheye ? 200.0 + 100.0 * part(random) : 80.0 + 50.0 * part(random);
    return camera;
}

TEST(RayThrough, IsWhatSeenAtUndoes) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-0.9, 0.9), way(0.1, 300.0);
    int seen = 0;
    for (int n = 0; n < 2000; ++n) {
        const Camera camera = randomCamera(random, n % 2 ? Lens::fisheye : Lens::perspective);
        const glm::dvec2 at(place(random), place(random));
        const auto ray = rayThrough(camera, at);
        const bool black =
            camera.lens == Lens::fisheye && 2.0 * glm::length(at) * 0.5 * camera.fovDegrees > 180.0;
        ASSERT_EQ(ray.has_value(), !black);
        if (!ray) continue;
        EXPECT_NEAR(glm::length(*ray), 1.0, 1e-12);
        const auto back = reader::seenAt(camera, camera.positionMm + way(random) * *ray);
        ASSERT_TRUE(back);
        EXPECT_LT(glm::distance(*back, at), 1e-9);
        ++seen;
    }
    EXPECT_GT(seen, 1500);
    EXPECT_EQ(rayThrough(Camera{}, {0.0, 0.0}), glm::dvec3(0, 0, 1));
    Camera flat;
    flat.lens = Lens::orthographic;
    EXPECT_FALSE(rayThrough(flat, {0.1, 0.2}));
}

TEST(RayThrough, IsTheRayThatPicturesAreDrawnBy) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    for (int n = 0; n < 500; ++n) {
        Camera camera = randomCamera(random, n % 2 ? Lens::fisheye : Lens::perspective);
        camera.forward *= 3.0;  // neither unit nor orthogonal
        camera.up += 0.1 * camera.forward;
        const double aspect = 1.6;
        const glm::dvec2 at(place(random), place(random));
        const auto drawn = render::lensRay(render::lensFrame(camera, aspect), at);
        const auto ray = rayThrough(camera, 0.5 * glm::dvec2(aspect * at.x, at.y));
        ASSERT_EQ(drawn.has_value(), ray.has_value());
        if (ray) {
            EXPECT_LT(glm::distance(*ray, drawn->direction), 1e-9);
        }
    }
}

/// Of the tube's wall, by a search along its profile.
double distanceToWall(const tests::FlatTube& tube, glm::dvec3 p) {
    double least = INFINITY;
    for (double y = 0.0; y <= tube.height(); y += 0.0005) {
        const glm::dvec3 wall = tube.positionMm({0.0, y});
        least = std::min(least, std::hypot(std::hypot(p.x, p.y) - wall.x, p.z - wall.z));
    }
    return least;
}

class Pick : public testing::Test {
protected:
    static constexpr double spacingMm = 0.8;
    static const tests::FlatTube& tube() {
        static const tests::FlatTube made;
        return made;
    }
    static OpenCase bareCase() {
        OpenCase of;
        static const auto scan =
            std::make_shared<const Volume<std::int16_t>>(tube().scan(spacingMm));
        of.ct = scan;
        of.grid = scan->grid();
        of.centerline = tube().centerline();
        return of;
    }
    static OpenCase meshedCase() {
        OpenCase of = bareCase();
        of.surface = std::make_shared<const TriMesh>(tube().map().surface);
        return of;
    }
    static OpenCase flatCase() {
        OpenCase of = bareCase();
        of.wall = makeWall(std::make_shared<const FlatMap>(tube().map())).value();
        return of;
    }
    static std::optional<WallPlace> pick(const OpenCase& of, const PickRay& ray) {
        const auto found = answer(of, CaseQuestion(ray));
        if (!found) {
            EXPECT_EQ(found.error().kind, ErrorKind::badInput);
            return std::nullopt;
        }
        return std::get<WallPlace>(*found);
    }
};

TEST_F(Pick, LiesOnTheWallAndIsSeenWhereItWasClicked) {
    const OpenCase flat = flatCase(), meshed = meshedCase(), bare = bareCase();
    std::mt19937 random(6);
    std::uniform_real_distribution<double> place(-0.6, 0.6);
    int wall = 0;
    for (int n = 0; n < 200; ++n) {
        Camera camera = randomCamera(random, n % 3 == 0 ? Lens::fisheye : Lens::perspective);
        camera.positionMm = {3.0 * place(random), 3.0 * place(random), 30.0 + 8.0 * place(random)};
        const glm::dvec2 at(place(random), place(random));
        const auto ray = rayThrough(camera, at);
        if (!ray) continue;
        const auto inStrip = pick(flat, {camera.positionMm, *ray});
        if (!inStrip || inStrip->flatTriangle < 0) continue;  // through an end
        ++wall;
        // Triangles are chords of the wall, up to 0.1 mm within it.
        EXPECT_LT(distanceToWall(tube(), inStrip->positionMm), 0.15);
        EXPECT_LT(glm::distance(tube().positionMm(inStrip->flat), inStrip->positionMm), 0.3);
        const auto seen = reader::seenAt(camera, inStrip->positionMm);
        ASSERT_TRUE(seen);
        EXPECT_LT(glm::distance(*seen, at), 1e-4);
        EXPECT_NEAR(inStrip->arcMm, inStrip->positionMm.z, 2.0);

        // The mesh is the same triangles: the same place, without the strip.
        const auto onMesh = pick(meshed, {camera.positionMm, *ray});
        ASSERT_TRUE(onMesh);
        EXPECT_LT(glm::distance(onMesh->positionMm, inStrip->positionMm), 1e-3);
        EXPECT_LT(onMesh->flatTriangle, 0);
        EXPECT_EQ(onMesh->sourceTriangle, inStrip->sourceTriangle);
        const CenterlinePose pose = poseAtArc(tube().centerline(), onMesh->arcMm);
        EXPECT_LT(glm::distance(onMesh->cameraMm, pose.point.positionMm), 1e-9);
        EXPECT_NEAR(onMesh->arcMm, onMesh->positionMm.z, 0.5);

        // And the scan's, to within a voxel of the wall.
        const auto inScan = pick(bare, {camera.positionMm, *ray});
        ASSERT_TRUE(inScan);
        EXPECT_LT(inScan->sourceTriangle, 0);
        EXPECT_LT(distanceToWall(tube(), inScan->positionMm), spacingMm);
        ASSERT_TRUE(reader::seenAt(camera, inScan->positionMm));
        EXPECT_LT(glm::distance(*reader::seenAt(camera, inScan->positionMm), at), 1e-6);
    }
    EXPECT_GT(wall, 100);
}

TEST_F(Pick, ThroughTheOpenEndMeetsTheScansEnd) {
    // The strip ends at z = 0, where the scan's tube goes on for 4 mm.
    const auto place = pick(flatCase(), {{0, 0, 20}, {0, 0, -1}});
    ASSERT_TRUE(place);
    EXPECT_LT(place->flatTriangle, 0);
    EXPECT_NEAR(place->positionMm.z, -4.0, spacingMm);
    EXPECT_EQ(place->arcMm, 0.0);
}

TEST_F(Pick, OfAScanAloneBeginsWhereItStands) {
    OpenCase of = bareCase();
    of.centerline = {};
    const auto place = pick(of, {{0, 0, 30}, {1, 0, 0}});
    ASSERT_TRUE(place);
    EXPECT_EQ(place->cameraMm, glm::dvec3(0, 0, 30));
    EXPECT_EQ(place->arcMm, 0.0);
    EXPECT_LT(distanceToWall(tube(), place->positionMm), spacingMm);
    // In tissue there is nothing before the eye; from without, the scan's side.
    const double side = of.grid.patientFromVoxelPoint({-0.5, 0, 0}).x;
    const auto within = pick(of, {{side + 1.0, 0, 30}, {1, 0, 0}});
    ASSERT_TRUE(within);
    EXPECT_LT(glm::distance(within->positionMm, glm::dvec3(side + 1.0, 0, 30)), 1e-9);
    const auto without = pick(of, {{side - 50.0, 0, 30}, {2, 0, 0}});
    ASSERT_TRUE(without);
    EXPECT_LT(glm::distance(without->positionMm, glm::dvec3(side, 0, 30)), 1e-9);
    EXPECT_FALSE(pick(of, {{side - 50.0, 0, 30}, {-1, 0, 0}}));
    EXPECT_FALSE(pick(of, {{side - 50.0, 0, 30}, {0, 1, 0}}));
}

TEST_F(Pick, OfACleansedCaseMeetsNoResidue) {
    OpenCase of = bareCase();
    // Fluid up to x = 3 mm from the axis, which cleansing takes away.
    Volume<std::int16_t> fluid = of.ct->clone();
    for (std::size_t n = 0; n < fluid.grid().voxelCount(); ++n)
        if (fluid.grid().patientFromVoxelPoint(glm::dvec3(fluid.grid().voxelAt(n))).x > 3.0)
            fluid.writable()[n] = 400;
    of.cleansedScan = of.ct;
    of.ct = std::make_shared<const Volume<std::int16_t>>(std::move(fluid));
    const PickRay ray{{0, 0, 30}, {1, 0, 0}};
    EXPECT_LT(distanceToWall(tube(), pick(of, ray)->positionMm), spacingMm);
    of.cleansedScan = nullptr;
    EXPECT_NEAR(pick(of, ray)->positionMm.x, 3.0, spacingMm);
}

}  // namespace
}  // namespace haustra::session
