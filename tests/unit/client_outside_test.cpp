// The overview's map, fisheye cameras and transfer functions made by hand.
#include "reader/flight.h"
#include "reader/overview_map.h"
#include "script/script.h"
#include "temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace haustra::reader {
namespace {

/// Once around a circle of 60 mm in the coronal plane, and on behind it.
Centerline ring() {
    Centerline path;
    for (int n = 0; n < 400; ++n) {
        const double angle = 2.0 * M_PI * n / 300.0;
        path.points.push_back(
            {{60.0 * std::cos(angle), n < 300 ? 0.0 : 40.0, 60.0 * std::sin(angle)}, 1.25 * n});
    }
    return path;
}

TEST(OverviewMap, AClickFindsThePathThatIsDrawnThere) {
    const Centerline path = ring();
    Orbit orbit = orbitOf(path, 1.0);
    const glm::dvec2 size(300.0, 300.0);
    for (const double azimuth : {0.0, 35.0, -60.0}) {
        orbit.azimuthDegrees = azimuth;
        for (int n = 130; n < 300; n += 17) {
            const glm::dvec3 seen = projected(orbit, path.points[std::size_t(n)].positionMm, size);
            const auto arc = arcAt(orbit, path, glm::dvec2(seen) + 0.4, size, 20.0);
            ASSERT_TRUE(arc);
            const auto& found = path.points[std::size_t(std::lround(*arc / 1.25))];
            const glm::dvec3 there = projected(orbit, found.positionMm, size);
            EXPECT_LT(glm::distance(glm::dvec2(there), glm::dvec2(seen)), 5.0);
        }
    }
    EXPECT_FALSE(arcAt(orbit, path, {2.0, 2.0}, size, 20.0));
    EXPECT_FALSE(arcAt(orbit, {}, {150.0, 150.0}, size, 1e9));
}

TEST(OverviewMap, OfTwoStretchesInFrontOfEachOtherTheNearerIsMeant) {
    const Centerline path = ring();  // its first third lies before its last
    Orbit orbit = orbitOf(path, 1.0);
    const glm::dvec2 size(300.0, 300.0);
    const glm::dvec2 pixel(projected(orbit, path.points[40].positionMm, size));
    EXPECT_NEAR(*arcAt(orbit, path, pixel, size, 10.0), 1.25 * 40, 4.0);
    orbit.azimuthDegrees = 180.0;
    const glm::dvec2 behind(projected(orbit, path.points[340].positionMm, size));
    EXPECT_NEAR(*arcAt(orbit, path, behind, size, 10.0), 1.25 * 340, 4.0);
}

TEST(OverviewMap, FindsTheNearestOfSeveralPlaces) {
    const Orbit orbit{{0, 0, 0}, 500.0, 0.0, 0.0, 200.0};
    const std::vector<glm::dvec3> places{{10, 0, 0}, {14, 50, 0}, {-30, 0, 20}};
    const glm::dvec2 size(200.0, 200.0);  // a pixel a millimetre
    EXPECT_EQ(placeAt(orbit, places, {111.0, 100.0}, size, 8.0), 0u);
    EXPECT_EQ(placeAt(orbit, places, {113.0, 100.0}, size, 8.0), 1u);
    EXPECT_EQ(placeAt(orbit, places, {71.0, 81.0}, size, 8.0), 2u);
    EXPECT_FALSE(placeAt(orbit, places, {150.0, 100.0}, size, 8.0));
    EXPECT_FALSE(placeAt(orbit, {}, {100.0, 100.0}, size, 8.0));
}

TEST(Fisheye, EqualAnglesAreEqualLengths) {
    Camera camera{{1, 2, 3}, {0, 0, 1}, {0, -1, 0}, 200.0, Lens::fisheye};
    for (const double degrees : {0.0, 20.0, 60.0, 95.0, 140.0}) {
        const double angle = glm::radians(degrees);
        const auto seen = seenAt(
            camera, camera.positionMm + 30.0 * glm::dvec3(std::sin(angle), 0, std::cos(angle)));
        ASSERT_TRUE(seen);
        EXPECT_NEAR(seen->x, degrees / 200.0, 1e-12);  // right of the middle, in heights
        EXPECT_NEAR(seen->y, 0.0, 1e-12);
    }
    const auto above = seenAt(camera, camera.positionMm + glm::dvec3(0, -5, 5));
    EXPECT_NEAR(above->y, -45.0 / 200.0, 1e-12);
    camera = {{0, 0, 0}, {0, 0, 1}, {0, -1, 0}, 90.0};
    EXPECT_NEAR(seenAt(camera, {0.5, 0, 1})->x, 0.25, 1e-12);
    EXPECT_FALSE(seenAt(camera, {0, 0, -1}));
    EXPECT_FALSE(seenAt(camera, {1, 0, 0}));
}

TEST(Fisheye, KeepsItsOwnFieldOfView) {
    Flight flight{Centerline{}};
    flight.setFov(70.0);
    flight.setFisheye(true);
    EXPECT_EQ(flight.camera().lens, Lens::fisheye);
    EXPECT_EQ(flight.camera().fovDegrees, 180.0);
    flight.setFov(1000.0);
    EXPECT_EQ(flight.camera().fovDegrees, 240.0);
    flight.setFisheye(false);
    EXPECT_EQ(flight.camera(), (Camera{{}, flight.camera().forward, flight.camera().up, 70.0}));
    flight.setFisheye(true);
    EXPECT_EQ(flight.camera().fovDegrees, 240.0);
}

Result<std::vector<Action>> parse(const std::string& text) {
    std::istringstream in(text);
    return parseScript(in, "tour.jsonl");
}

TEST(Script, ReadsTheActionsOfTheViewsFromOutside) {
    const auto actions = parse(R"({"do":"overview","azimuth_deg":30,"body":false,"png":"o.png"}
{"do":"oblique","forward":[0,1,0],"up":[0,0,1],"height_mm":40}
{"do":"go","lens":"fisheye","fov_deg":200}
{"do":"transfer","points":[[-700,1,0,0,0],[-500,1,0.5,0,0.9]]}
{"do":"view","view":"overview","viewport":7})");
    ASSERT_TRUE(actions) << describe(actions.error());
    const auto& overview = std::get<OverviewAction>((*actions)[0].body);
    EXPECT_EQ(overview.azimuthDegrees, 30.0);
    EXPECT_FALSE(overview.body);
    EXPECT_TRUE(overview.reader);
    EXPECT_EQ(overview.viewport, 7);
    const auto& oblique = std::get<ObliqueAction>((*actions)[1].body);
    EXPECT_EQ(oblique.up, glm::dvec3(0, 0, 1));
    EXPECT_EQ(oblique.heightMm, 40.0);
    EXPECT_EQ(oblique.viewport, 6);
    EXPECT_EQ(std::get<GoAction>((*actions)[2].body).fisheye, true);
    const auto& optics = std::get<Optics>(std::get<TransferAction>((*actions)[3].body).optics);
    ASSERT_EQ(optics.transferFunction.points.size(), 2u);
    EXPECT_EQ(optics.transferFunction.points[1],
              (TransferFunctionPoint{-500.0, {1.0, 0.5, 0.0}, 0.9}));
}

TEST(Script, OpticsAreGivenWholeOrByAPresetsFile) {
    const tests::TemporaryFolder folder;
    const auto file = folder / "look.json";
    const std::string own = R"("composition":"first-hit","shading":false,
        "light":{"halfDepthMm":9,"ambient":0.1,"diffuse":1,"specular":0.3,"shininess":4},
        "points":[{"hu":-1,"color":[1,0,0],"opacity":0},{"hu":1,"color":[0,1,0],"opacity":1}],
        "rows":[{"gradientHuPerMm":90,"points":[{"hu":-5,"color":[1,0,0],"opacity":0.5},
                                                {"hu":1,"color":[0,1,0],"opacity":1}]}]})";
    std::ofstream(file) << R"({"name":"look",)" << own;
    std::string line = R"({"do":"transfer","viewport":3,"optics":{)" + own + "}\n";
    std::erase(line, '\n');
    const auto actions =
        parse(line + "\n" + R"({"do":"transfer","file":")" + file.string() + "\"}");
    ASSERT_TRUE(actions) << describe(actions.error());
    const auto& whole = std::get<TransferAction>((*actions)[0].body);
    EXPECT_EQ(whole.viewport, 3);
    const auto& optics = std::get<Optics>(whole.optics);
    EXPECT_EQ(optics.composition, Composition::firstHit);
    EXPECT_FALSE(optics.shading);
    EXPECT_EQ(optics.light, (Headlight{9, 0.1, 1, 0.3, 4}));
    ASSERT_EQ(optics.transferFunction.rows.size(), 1u);
    EXPECT_EQ(optics.transferFunction.rows[0].points[0].opacity, 0.5);
    EXPECT_EQ(std::get<TransferAction>((*actions)[1].body).optics, OpticsChoice(optics));
    std::filesystem::remove(file);
    EXPECT_FALSE(parse(R"({"do":"transfer","file":")" + file.string() + "\"}"));
}

TEST(Script, ActionsOfTheViewsFromOutsideHaveTheirBounds) {
    for (const char* line : {
             R"({"do":"overview","elevation_deg":91})",
             R"({"do":"overview","body":"yes"})",
             R"({"do":"overview","position_mm":[0,0,0]})",
             R"({"do":"oblique","height_mm":0})",
             R"({"do":"oblique","forward":[0,0,1]})",
             R"({"do":"oblique","forward":[0,0,1],"up":[0,0,-2]})",
             R"({"do":"go","lens":"wide"})",
             R"({"do":"go","fov_deg":200})",
             R"({"do":"transfer"})",
             R"({"do":"transfer","preset":"mucosa","points":[[0,1,1,1,0],[1,1,1,1,1]]})",
             R"({"do":"transfer","points":[[0,1,1,1,0]]})",
             R"({"do":"transfer","points":[[0,1,1,1,0],[-1,1,1,1,1]]})",
             R"({"do":"transfer","points":[[0,1,1,1,0],[1,1,1,1,2]]})",
         }) {
        const auto actions = parse(line);
        ASSERT_FALSE(actions) << line;
        EXPECT_EQ(actions.error().place, "tour.jsonl:1") << line;
    }
}

}  // namespace
}  // namespace haustra::reader
