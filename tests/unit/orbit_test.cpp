// Cameras that circle a place.
#include "core/orbit.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace haustra {
namespace {

void expectNear(glm::dvec3 a, glm::dvec3 b, double error = 1e-9) {
    EXPECT_NEAR(glm::distance(a, b), 0.0, error)
        << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

TEST(Orbit, StandsWhereItsAnglesSay) {
    const glm::dvec3 center(10.0, -20.0, 30.0);
    const auto at = [&](double azimuth, double elevation) {
        return cameraOf({center, 100.0, azimuth, elevation, 50.0});
    };
    expectNear(at(0, 0).positionMm, center + glm::dvec3(0, -100, 0));    // before the patient
    expectNear(glm::cross(at(0, 0).forward, at(0, 0).up), {1, 0, 0});    // the patient's left
    expectNear(at(0, 0).up, {0, 0, 1});                                  // the head
    expectNear(at(90, 0).positionMm, center + glm::dvec3(100, 0, 0));    // at the patient's left
    expectNear(at(180, 0).positionMm, center + glm::dvec3(0, 100, 0));   // behind
    expectNear(at(0, 90).positionMm, center + glm::dvec3(0, 0, 100));    // above the head
    expectNear(at(0, -90).positionMm, center + glm::dvec3(0, 0, -100));  // at the feet
    expectNear(at(0, -90).up, {0, -1, 0});                               // the front is up
}

TEST(Orbit, LooksAtItsCentreWithUnitOrthogonalAxes) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> angle(-180.0, 180.0);
    for (int n = 0; n < 200; ++n) {
        const Orbit orbit{{1, 2, 3}, 80.0, angle(random), angle(random) / 2.0, 60.0};
        const Camera pose = cameraOf(orbit);
        const glm::dvec3 right = glm::cross(pose.forward, pose.up);
        EXPECT_NEAR(glm::length(pose.forward), 1.0, 1e-12);
        EXPECT_NEAR(glm::length(pose.up), 1.0, 1e-12);
        EXPECT_EQ(pose.lens, Lens::orthographic);
        EXPECT_EQ(pose.heightMm, 60.0);
        EXPECT_NEAR(glm::dot(pose.forward, pose.up), 0.0, 1e-12);
        expectNear(pose.positionMm + 80.0 * pose.forward, orbit.centerMm);
        const glm::dvec3 seen =
            projected(orbit, orbit.centerMm + 6.0 * right + 3.0 * pose.up, {200.0, 120.0});
        expectNear(seen, {100.0 + 12.0, 60.0 - 6.0, 80.0});
    }
}

TEST(Orbit, HasTheWholeBoxInThePictureFromEverySide) {
    const glm::dvec3 low(-120, -60, 40), high(150, 80, 460);
    for (const double aspect : {0.5, 1.0, 1.8}) {
        Orbit orbit = orbitAround(low, high, aspect);
        const glm::dvec2 size(300.0 * aspect, 300.0);
        for (const double azimuth : {0.0, 90.0, 180.0, 270.0}) {
            orbit.azimuthDegrees = azimuth;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 seen =
                    projected(orbit,
                              {corner & 1 ? low.x : high.x, corner & 2 ? low.y : high.y,
                               corner & 4 ? low.z : high.z},
                              size);
                EXPECT_GT(seen.z, 0.0);
                EXPECT_TRUE(seen.x > 0.0 && seen.x < size.x && seen.y > 0.0 && seen.y < size.y);
            }
        }
    }
    EXPECT_GT(orbitAround({1, 1, 1}, {1, 1, 1}, 1.0).heightMm, 0.0);
}

}  // namespace
}  // namespace haustra
