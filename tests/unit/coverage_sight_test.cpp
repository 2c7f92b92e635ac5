// What simulated pictures show: laws that hold whatever the wall.
#include "core/missed_patches.h"
#include "coverage/corner_path.h"
#include "coverage/fine_wall.h"
#include "coverage/sight.h"
#include "coverage_vessels.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

namespace haustra::coverage {
namespace {

using Seen = std::vector<Visibility>;

struct Vessel {
    explicit Vessel(TriMesh wall, std::vector<std::uint8_t> bridged = {})
        : mesh(std::move(wall)),
          rays(WallRays::of(mesh, std::move(bridged)).value()),
          tree(rays),
          triangles(mesh.triangles.size()) {}

    Seen look(const Eyepiece& eyepiece, std::span<const CenterlineCamera> cameras,
              SightOptions options = {}) const {
        Seen seen(triangles, Visibility::unseen);
        EXPECT_TRUE(coverage::look(tree, eyepiece, cameras, seen, options));
        return seen;
    }
    Seen lookByEveryRay(const Eyepiece& eyepiece, std::span<const CenterlineCamera> cameras,
                        bool tellFully) const {
        Seen seen(triangles, Visibility::unseen);
        coverage::lookByEveryRay(*rays, eyepiece, cameras, seen, tellFully);
        return seen;
    }

    TriMesh mesh;
    std::shared_ptr<const WallRays> rays;
    SightTree tree;
    std::size_t triangles;
};

Eyepiece pinhole(int side = 512, double nearestMm = 3.0, double farthestMm = 100.0) {
    return Eyepiece::of(PinholePicture{90.0, side, nearestMm, farthestMm});
}

std::vector<CenterlineCamera> bothWays(const Centerline& line, int count) {
    auto cameras = flightCameras(line, count, FlightDirection::antegrade);
    const auto back = flightCameras(line, count, FlightDirection::retrograde);
    cameras.insert(cameras.end(), back.begin(), back.end());
    return cameras;
}

/// Anywhere in the folded tube, looking anywhere.
std::vector<CenterlineCamera> anywhere(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> way(-1.0, 1.0), along(8.0, 192.0), aside(-5.0, 5.0);
    std::vector<CenterlineCamera> cameras;
    while (int(cameras.size()) < count) {
        CenterlineCamera camera;
        camera.positionMm =
            tests::foldedAxis(along(random)) + glm::dvec3(aside(random), aside(random), 0.0);
        camera.forward = glm::dvec3(way(random), way(random), way(random));
        if (glm::length(camera.forward) < 0.1) continue;
        camera.forward = glm::normalize(camera.forward);
        camera.up = std::abs(camera.forward.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        cameras.push_back(camera);
    }
    return cameras;
}

TEST(CoverageSight, AConvexVesselIsSeenWhole) {
    const Vessel vessel(tests::capsule(15.0, 110.0, 72));
    const Centerline line = tests::straightLine(4.0, 106.0);
    const auto seen = vessel.look(pinhole(), bothWays(line, 60), {.tellFully = true});
    EXPECT_EQ(std::count(seen.begin(), seen.end(), Visibility::fully), std::ptrdiff_t(seen.size()));
    // A colonoscope sees 140°: what lies beside it where it turns round is in neither picture, but
    // in the next ones.
    auto scope = scopeCameras(line, 60, FlightDirection::antegrade);
    const auto back = scopeCameras(line, 60, FlightDirection::retrograde);
    scope.insert(scope.end(), back.begin(), back.end());
    const auto observed = vessel.look(Eyepiece::of(olympusCfQ160l()), scope);
    EXPECT_EQ(std::count(observed.begin(), observed.end(), Visibility::unseen), 0);
}

TEST(CoverageSight, AHiddenPocketIsMissedToTheTriangle) {
    const Vessel vessel(tests::pocketTube());
    const Centerline line = tests::straightLine(5.0, tests::lastEyeMm);
    const auto seen = vessel.look(
        pinhole(1024), flightCameras(line, 36, FlightDirection::antegrade), {.tellFully = true});
    double pocketMm2 = 0.0;
    std::size_t pocketTriangles = 0;
    for (std::size_t n = 0; n < vessel.triangles; ++n) {
        glm::dvec2 low(1e9), high(-1e9);  // radius, z
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 v =
                vessel.mesh.vertices[std::size_t(vessel.mesh.triangles[n][corner])];
            const glm::dvec2 at(glm::length(glm::dvec2(v)), v.z);
            low = glm::min(low, at), high = glm::max(high, at);
        }
        // Beside the first camera, or nearly beyond the depth of field.
        if (low.y < 25.0 || high.y > 125.0) continue;
        // The fold's inner rim, which pictures graze.
        if (high.x < 8.1) continue;
        const bool pocket = low.y > tests::pocketBeginMm - 0.1 && high.y < tests::pocketEndMm + 0.1;
        EXPECT_EQ(seen[n] == Visibility::unseen, pocket) << low.x << " " << low.y;
        if (pocket) pocketMm2 += tests::triangleAreaMm2(vessel.mesh, n), ++pocketTriangles;
    }
    std::vector<std::uint8_t> observed;
    for (const Visibility one : seen)
        observed.push_back(one != Visibility::unseen);
    const auto patches = missedPatches(vessel.mesh, neighboursOf(vessel.mesh), observed, {}, line);
    const auto found = std::find_if(patches.begin(), patches.end(), [](const MissedPatch& patch) {
        return patch.centerMm.z >= tests::pocketBeginMm && patch.centerMm.z < tests::pocketEndMm;
    });
    ASSERT_NE(found, patches.end());
    EXPECT_EQ(found->triangles.size(), pocketTriangles);
    EXPECT_NEAR(found->areaMm2, pocketMm2, 1e-6 * pocketMm2);
    // A frustum of 72 sides, and the fold's back.
    const double sides = 72.0 * std::sin(std::numbers::pi / 72.0);
    EXPECT_NEAR(pocketMm2,
                2.0 * sides * 15.0 * (tests::pocketEndMm - tests::pocketBeginMm) +
                    sides * std::cos(std::numbers::pi / 72.0) * (15.0 * 15.0 - 8.0 * 8.0),
                1e-6 * pocketMm2);
}

TEST(CoverageSight, FewRaysShowWhatEveryRayShows) {
    const Vessel folded(tests::foldedTube());
    const auto cameras = anywhere(12, 7);
    for (const bool tellFully : {false, true}) {
        for (const Eyepiece& eyepiece :
             {pinhole(128), pinhole(128, 12.0, 30.0), Eyepiece::of(olympusCfQ160l())}) {
            const std::span some =
                std::span(cameras).first(eyepiece.openPixels() > 50'000 ? 3 : 12);
            const auto few = folded.look(eyepiece, some, {.tellFully = tellFully});
            const auto every = folded.lookByEveryRay(eyepiece, some, tellFully);
            EXPECT_EQ(few, every);
            const auto unseen = std::count(few.begin(), few.end(), Visibility::unseen);
            EXPECT_GT(unseen, 100);
            EXPECT_LT(unseen, std::ptrdiff_t(few.size()) - 1000);
        }
    }
    // Triangles that are larger than pictures, beside and behind the camera.
    const Vessel coarse(tests::foldedTube(5));
    for (const Eyepiece& eyepiece : {pinhole(64), Eyepiece::of(olympusCfQ160l())})
        EXPECT_EQ(coarse.look(eyepiece, std::span(cameras).first(4), {.tellFully = true}),
                  coarse.lookByEveryRay(eyepiece, std::span(cameras).first(4), true));
}

TEST(CoverageSight, AFieldWiderThanAHalfSpaceLosesNothing) {
    Colonoscope wide = olympusCfQ160l();
    wide.lens.k = {10.0};
    wide.lens.mu = wide.lens.mv = 8.0;
    wide.pictureSize = {400, 400};
    wide.lens.u0 = wide.lens.v0 = 199.5;
    wide.openCenter = {199.5, 199.5};
    wide.openRadii = {170.0, 160.0};
    wide.fieldDegrees = 235.0;
    const Eyepiece eyepiece = Eyepiece::of(wide);
    const Vessel folded(tests::foldedTube(48));
    const auto cameras = anywhere(4, 3);
    EXPECT_EQ(folded.look(eyepiece, cameras), folded.lookByEveryRay(eyepiece, cameras, false));
}

// Independent of Embree: every triangle against every ray in doubles.
TEST(CoverageSight, RaysShowWhatArithmeticSays) {
    const Vessel folded(tests::foldedTube(24));
    const Eyepiece eyepiece = pinhole(48);
    std::size_t shown = 0;
    for (const CenterlineCamera& camera : anywhere(4, 11)) {
        const Pose pose(camera, folded.rays->originMm());
        std::set<std::size_t> surely, perhaps;
        for (const glm::vec3 direction : eyepiece.directions()) {
            const glm::dvec3 from(pose.eye), along(pose.toWorld(direction));
            struct Met {
                double mm;
                std::size_t triangle;
            };
            std::vector<Met> met;
            for (std::size_t n = 0; n < folded.triangles; ++n) {
                const auto& c = folded.rays->facet(n).corners;
                const glm::dvec3 a(c[0]), ab = glm::dvec3(c[1]) - a, ac = glm::dvec3(c[2]) - a;
                const glm::dvec3 p = glm::cross(along, ac);
                const double determinant = glm::dot(ab, p);
                if (std::abs(determinant) < 1e-12) continue;
                const double u = glm::dot(from - a, p) / determinant;
                const glm::dvec3 q = glm::cross(from - a, ab);
                const double v = glm::dot(along, q) / determinant,
                             mm = glm::dot(ac, q) / determinant;
                if (u > -1e-4 && v > -1e-4 && u + v < 1.0 + 1e-4 && mm > 0.0)
                    met.push_back({mm, n});
            }
            ASSERT_FALSE(met.empty()) << "the vessel is closed";
            double nearest = 1e9;
            for (const Met& one : met)
                nearest = std::min(nearest, one.mm);
            std::vector<std::size_t> first;
            for (const Met& one : met)
                if (one.mm < nearest + 2e-3) first.push_back(one.triangle);
            if (nearest < 3.0 - 1e-3 || nearest > 100.0 + 1e-3) continue;
            for (const std::size_t triangle : first)
                perhaps.insert(triangle);
            if (first.size() == 1) surely.insert(first.front());
        }
        const auto seen = folded.lookByEveryRay(eyepiece, {&camera, 1}, false);
        for (std::size_t n = 0; n < folded.triangles; ++n) {
            if (seen[n] != Visibility::unseen) {
                EXPECT_TRUE(perhaps.contains(n));
            }
            if (surely.contains(n)) {
                EXPECT_NE(seen[n], Visibility::unseen);
            }
        }
        const auto packets = trianglesSeen(*folded.rays, eyepiece, camera);
        for (const std::int32_t n : packets)
            EXPECT_TRUE(perhaps.contains(std::size_t(n)));
        for (const std::size_t n : surely)
            EXPECT_TRUE(std::binary_search(packets.begin(), packets.end(), std::int32_t(n)));
        shown += surely.size();
    }
    EXPECT_GT(shown, 300u);
}

TEST(CoverageSight, PartlyIsWhatSomethingStandsBefore) {
    const Vessel vessel(tests::pocketTube());
    // Through the fold's hole: of what stands behind it, the strip along its shadow is partly seen.
    const CenterlineCamera camera{{0.0, 0.0, 20.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}};
    const auto seen = vessel.look(pinhole(2048), {&camera, 1}, {.tellFully = true});
    // The shadow of the hole's far rim at radius 15.
    const double shadowMm = 20.0 + 15.0 * (tests::pocketBeginMm - 20.0) / 8.0;
    int fully = 0, partly = 0;
    for (std::size_t n = 0; n < vessel.triangles; ++n) {
        double low = 1e9, high = -1e9;
        for (int corner = 0; corner < 3; ++corner) {
            const double z = vessel.mesh.vertices[std::size_t(vessel.mesh.triangles[n][corner])].z;
            low = std::min(low, z), high = std::max(high, z);
        }
        if (low < tests::pocketBeginMm + 0.1) continue;
        if (high < shadowMm - 0.01) {
            EXPECT_EQ(seen[n], Visibility::unseen) << low;
        } else if (low > shadowMm + 0.01 && high < 119.0) {
            EXPECT_EQ(seen[n], Visibility::fully) << low;
            ++fully;
        } else if (low < shadowMm - 0.3 && high > shadowMm + 0.3) {
            EXPECT_EQ(seen[n], Visibility::partly) << low;
            ++partly;
        }
    }
    EXPECT_GT(fully, 500);
    EXPECT_GT(partly, 50);
}

TEST(CoverageSight, WhatIsSeenOnlyGrowsAndAnyNumberOfThreadsSeesTheSame) {
    const Vessel folded(tests::foldedTube());
    const Centerline line = tests::lineThrough(tests::foldedAxis, 6.0, 194.0);
    const auto there =
                   folded.look(pinhole(96), flightCameras(line, 24, FlightDirection::antegrade)),
               back =
                   folded.look(pinhole(96), flightCameras(line, 24, FlightDirection::retrograde));
    const auto both = folded.look(pinhole(96), bothWays(line, 24));
    Seen sum = there;
    addSeen(sum, back);
    EXPECT_EQ(both, sum) << "both ways is what each sees, no more and no less";
    EXPECT_NE(both, there);
    for (const bool tellFully : {false, true}) {
        const auto one =
            folded.look(pinhole(96), bothWays(line, 24), {.tellFully = tellFully, .threads = 1});
        for (const int threads : {2, 5})
            EXPECT_EQ(folded.look(pinhole(96), bothWays(line, 24),
                                  {.tellFully = tellFully, .threads = threads}),
                      one);
    }
    // What is known beforehand stays.
    Seen more = there;
    EXPECT_TRUE(
        look(folded.tree, pinhole(96), flightCameras(line, 24, FlightDirection::retrograde), more));
    EXPECT_EQ(more, both);
}

TEST(CoverageSight, BridgesStopRaysAndAreNeverSeen) {
    const TriMesh mesh = tests::capsule(15.0, 110.0, 48);
    std::vector<std::uint8_t> bridged;
    for (const glm::ivec3& t : mesh.triangles)
        bridged.push_back(mesh.vertices[std::size_t(t.x)].z > 60.0);
    const Vessel plain(mesh), bridging(mesh, bridged);
    const auto cameras = bothWays(tests::straightLine(4.0, 106.0), 20);
    const auto all = plain.look(pinhole(128), cameras), some = bridging.look(pinhole(128), cameras);
    for (std::size_t n = 0; n < all.size(); ++n)
        EXPECT_EQ(some[n], bridged[n] ? Visibility::unseen : all[n]);
}

TEST(CoverageSight, CancellingLeavesWhatWasKnown) {
    const Vessel vessel(tests::capsule(15.0, 110.0, 24));
    Seen seen(vessel.triangles, Visibility::unseen);
    const auto stopped =
        look(vessel.tree, pinhole(64), bothWays(tests::straightLine(4.0, 106.0), 9), seen,
             {.cancelled = [] { return true; }});
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::wrongState);
    EXPECT_EQ(seen, Seen(vessel.triangles, Visibility::unseen));
}

TEST(FineWall, IsTheSameWallInSmallTriangles) {
    const TriMesh coarse = tests::foldedTube(9);
    const FineWall fine = fineWall(coarse, 1.5);
    EXPECT_TRUE(meshTopology(fine.mesh).closed());
    EXPECT_EQ(meshTopology(fine.mesh).genus(), 0);
    std::vector<double> areas(coarse.triangles.size(), 0.0);
    for (std::size_t n = 0; n < fine.mesh.triangles.size(); ++n) {
        const glm::ivec3 t = fine.mesh.triangles[n];
        for (int side = 0; side < 3; ++side)
            EXPECT_LE(glm::distance(fine.mesh.vertices[std::size_t(t[side])],
                                    fine.mesh.vertices[std::size_t(t[(side + 1) % 3])]),
                      1.5);
        EXPECT_LT(tests::triangleAreaMm2(fine.mesh, n), 1.0);
        const auto source = std::size_t(fine.sourceTriangle[n]);
        areas[source] += tests::triangleAreaMm2(fine.mesh, n);
        // Wound alike, in the same plane.
        const auto normal = [](const TriMesh& mesh, glm::ivec3 corners) {
            const glm::dvec3 a = mesh.vertices[std::size_t(corners.x)];
            return glm::normalize(glm::cross(mesh.vertices[std::size_t(corners.y)] - a,
                                             mesh.vertices[std::size_t(corners.z)] - a));
        };
        EXPECT_GT(glm::dot(normal(fine.mesh, t), normal(coarse, coarse.triangles[source])),
                  1.0 - 1e-9);
    }
    for (std::size_t n = 0; n < areas.size(); ++n)
        EXPECT_NEAR(areas[n], tests::triangleAreaMm2(coarse, n), 1e-9 * areas[n]);
    EXPECT_EQ(fineWall(fine.mesh, 1.5).mesh.triangles, fine.mesh.triangles);
}

}  // namespace
}  // namespace haustra::coverage
