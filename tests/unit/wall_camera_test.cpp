#include "core/wall_camera.h"

#include "analytic_tubes.h"

#include <random>

#include <gtest/gtest.h>

namespace haustra {
namespace {

constexpr double heightUnits = 4.0, circumferenceMm = 150.0;

// Cameras on the axis, in millimetres, one per row.
FlatMap cylinderMap() {
    FlatMap map = tests::flatMapOf(tests::cylinder(circumferenceMm), heightUnits, 90, 80);
    for (FlatCamera& camera : map.cameras) {
        camera.arcMm *= circumferenceMm;
        camera.positionMm *= circumferenceMm;
    }
    return map;
}

// Where a place lies from the middle of a camera's picture: to the right, up, and ahead.
glm::dvec3 inPicture(const CenterlineCamera& camera, glm::dvec3 positionMm) {
    const glm::dvec3 v = positionMm - camera.positionMm;
    return {glm::dot(v, glm::cross(camera.forward, camera.up)), glm::dot(v, camera.up),
            glm::dot(v, camera.forward)};
}

TEST(WallCamera, ShowsThePlaceAsTheFlatPictureDoes) {
    const auto map = std::make_shared<const FlatMap>(cylinderMap());
    const FlatLookup lookup(map);
    std::mt19937 random(5);
    const auto share = [&] { return double(random()) / 4294967296.0; };
    for (int n = 0; n < 300; ++n) {
        const glm::dvec2 flat(share(), 0.1 + (heightUnits - 0.2) * share());
        const WallPlace place = *lookup.at(flat);
        const CenterlineCamera camera = cameraTowards(*map, place, place.positionMm);
        EXPECT_NEAR(glm::length(camera.forward), 1.0, 1e-12);
        EXPECT_NEAR(glm::length(camera.up), 1.0, 1e-12);
        EXPECT_NEAR(glm::dot(camera.forward, camera.up), 0.0, 1e-12);
        EXPECT_EQ(camera.positionMm, place.cameraMm);
        const glm::dvec3 middle = inPicture(camera, place.positionMm);
        EXPECT_NEAR(middle.x, 0.0, 1e-9);
        EXPECT_NEAR(middle.y, 0.0, 1e-9);
        EXPECT_GT(middle.z, 0.0);
        // Columns of the flat picture run towards −x, rows upwards towards +y.
        const double step = 0.02;
        EXPECT_GT(inPicture(camera, lookup.at({flat.x - step, flat.y})->positionMm).x, 2.5);
        EXPECT_LT(inPicture(camera, lookup.at({flat.x + step, flat.y})->positionMm).x, -2.5);
        EXPECT_GT(inPicture(camera, lookup.at({flat.x, flat.y + step})->positionMm).y, 2.5);
        EXPECT_LT(inPicture(camera, lookup.at({flat.x, flat.y - step})->positionMm).y, -2.5);
    }
}

// A place that is looked at along the path, or lies in the camera, has a camera all the same.
TEST(WallCamera, AlwaysHasAnUpAcrossItsView) {
    FlatMap map = cylinderMap();
    WallPlace place;
    place.cameraMm = map.cameras[40].positionMm;
    place.arcMm = map.cameras[40].arcMm;
    const auto check = [&] {
        const CenterlineCamera camera = cameraTowards(map, place, place.positionMm);
        EXPECT_NEAR(glm::length(camera.forward), 1.0, 1e-12);
        EXPECT_NEAR(glm::length(camera.up), 1.0, 1e-12);
        EXPECT_NEAR(glm::dot(camera.forward, camera.up), 0.0, 1e-12);
    };
    place.positionMm = place.cameraMm + glm::dvec3(0.0, 0.0, 7.0);
    check();
    place.positionMm = place.cameraMm;
    check();
    map.cameras = {{{1.0, 2.0, 3.0}, 0.0}};
    place.positionMm = place.cameraMm + glm::dvec3(0.0, -4.0, 0.0);
    check();
}

}  // namespace
}  // namespace haustra
