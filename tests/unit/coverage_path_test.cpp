// Where simulated cameras stand.
#include "coverage/colonoscope.h"
#include "coverage/corner_path.h"
#include "coverage/coverage_report.h"
#include "coverage/fine_wall.h"
#include "coverage/path_planning.h"
#include "coverage_vessels.h"

#include <numbers>

#include <gtest/gtest.h>

namespace haustra::coverage {
namespace {

constexpr double tipMm = 6.4, spacingMm = 1.0, bendMm = 40.0;

/// A tube whose axis runs up, around a quarter of a circle of radius bendMm, and on along x; its
/// distance to the wall is exact. Narrow (radius 4) along `narrowMm` of its first leg.
struct BentTube {
    double radiusMm = 18.0, narrowMm = 0.0;

    glm::dvec3 axis(double s) const {
        const double turn = 0.5 * std::numbers::pi * bendMm;
        if (s < 60.0) return {0.0, 0.0, s};
        if (s < 60.0 + turn) {
            const double angle = (s - 60.0) / bendMm;
            return {bendMm * (1.0 - std::cos(angle)), 0.0, 60.0 + bendMm * std::sin(angle)};
        }
        return {bendMm + s - 60.0 - turn, 0.0, 60.0 + bendMm};
    }
    double lengthMm() const { return 120.0 + 0.5 * std::numbers::pi * bendMm; }
    double radiusAt(double s) const {
        return narrowMm > 0.0 && std::abs(s - 30.0) <= 0.5 * narrowMm ? 4.0 : radiusMm;
    }
    Centerline line() const {
        Centerline made = tests::lineThrough([&](double s) { return axis(s); }, 0.0, lengthMm());
        for (CenterlinePoint& point : made.points)
            point.radiusMm = wallMm(point.positionMm);
        return made;
    }
    /// Nearest to a point.
    double along(glm::dvec3 p) const {
        const double turn = 0.5 * std::numbers::pi * bendMm;
        const double angle =
            std::clamp(std::atan2(p.z - 60.0, bendMm - p.x), 0.0, 0.5 * std::numbers::pi);
        double best = 0.0;
        for (const double s : {std::clamp(p.z, 0.0, 60.0), 60.0 + bendMm * angle,
                               60.0 + turn + std::clamp(p.x - bendMm, 0.0, 60.0)})
            if (glm::distance(p, axis(s)) < glm::distance(p, axis(best))) best = s;
        return best;
    }
    double wallMm(glm::dvec3 p) const {
        const double s = along(p), aside = glm::distance(p, axis(s)),
                     before = std::abs(s - 30.0) - 0.5 * narrowMm;
        double mm = radiusAt(s) - aside;
        // The step at the narrow part's ends.
        if (narrowMm > 0.0 && before > 0.0)
            mm = std::min(mm, std::hypot(before, std::max(0.0, 4.0 - aside)));
        return std::max(0.0, mm);
    }
    Volume<float> distance() const {
        Volume<float> volume(
            axisAlignedGrid({130, 44, 130}, glm::dvec3(spacingMm), {-22.0, -22.0, -5.0}), 0.0f);
        const Grid& grid = volume.grid();
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            volume.writable()[n] = float(wallMm(grid.patientFromVoxelPoint(grid.voxelAt(n))));
        }
        return volume;
    }
};

TEST(CornerPath, HugsTheCornerAndKeepsItsDistance) {
    const BentTube tube;
    const auto found = cornerPath(tube.distance(), tube.line(), tipMm);
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_EQ(found->narrowMm, 0.0);
    double nearest = 1e9;
    for (const CenterlinePoint& point : found->path.points) {
        EXPECT_GE(point.radiusMm, tipMm - 1e-6);
        nearest = std::min(nearest, point.radiusMm);
    }
    EXPECT_LT(nearest, tipMm + spacingMm) << "it touches the corner's inner side";
    // A tight string around the inner side of the bend; steps between voxels go round by up to 8 %.
    const double inner = bendMm - (tube.radiusMm - tipMm), toCenter = std::hypot(60.0, bendMm);
    const double wrapped = 2.0 * std::numbers::pi -
                           std::acos(-2.0 * 60.0 * bendMm / (toCenter * toCenter)) -
                           2.0 * std::acos(inner / toCenter);
    const double string = inner * wrapped + 2.0 * std::sqrt(toCenter * toCenter - inner * inner);
    EXPECT_GT(found->path.lengthMm(), string - 3.0);
    EXPECT_LT(found->path.lengthMm(), 1.09 * string);
    EXPECT_GT(tube.line().lengthMm(), 1.09 * string);
    EXPECT_LT(found->path.points.front().positionMm.z, 8.0);
    EXPECT_GT(found->path.points.back().positionMm.x, 90.0);
}

TEST(CornerPath, GoesOnWhereTheTubeIsTooNarrowAndSaysHowFar) {
    for (const double narrowMm : {10.0, 24.0}) {
        BentTube tube;
        tube.narrowMm = narrowMm;
        const auto found = cornerPath(tube.distance(), tube.line(), tipMm);
        ASSERT_TRUE(found) << describe(found.error());
        // From where the step to the narrow part's radius of 4 mm is nearer than the tip allows.
        EXPECT_NEAR(found->narrowMm, narrowMm + 2.0 * std::sqrt(tipMm * tipMm - 4.0 * 4.0), 2.1);
        for (const CenterlinePoint& point : found->path.points) {
            if (std::abs(point.positionMm.z - 30.0) < 0.5 * narrowMm && point.positionMm.x < 20.0) {
                EXPECT_LT(glm::length(glm::dvec2(point.positionMm)), 1.0) << "in its middle";
            }
        }
    }
    BentTube thread;
    thread.radiusMm = 5.0;
    const auto found = cornerPath(thread.distance(), thread.line(), tipMm);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->narrowMm, thread.line().lengthMm(), 1e-6);
    EXPECT_FALSE(cornerPath(thread.distance(), {}, tipMm));
}

TEST(CornerPath, CamerasStandEvenlyAndLookAlongThePath) {
    const Centerline line = BentTube{}.line();
    for (const auto direction : {FlightDirection::antegrade, FlightDirection::retrograde}) {
        const auto cameras = scopeCameras(line, 50, direction);
        ASSERT_EQ(cameras.size(), 50u);
        for (std::size_t n = 0; n < cameras.size(); ++n) {
            EXPECT_NEAR(nearestArc(line, cameras[n].positionMm), line.lengthMm() * double(n) / 49.0,
                        1.0);
            EXPECT_NEAR(glm::dot(cameras[n].forward, cameras[n].up), 0.0, 1e-9);
            const glm::dvec3 tangent = poseAtArc(line, line.lengthMm() * double(n) / 49.0).tangent;
            EXPECT_NEAR(glm::dot(cameras[n].forward, tangent),
                        direction == FlightDirection::antegrade ? 1.0 : -1.0, 1e-9);
        }
    }
    EXPECT_EQ(flightCameras(line, 1, FlightDirection::antegrade).size(), 1u);
}

/// The folded tube as coverage sees it.
struct Folded {
    Folded() {
        wall.mesh = tests::foldedTube();
        wall.neighbours = neighboursOf(wall.mesh);
        wall.bridged.assign(wall.mesh.triangles.size(), 0);
        wall.centerline = tests::lineThrough(tests::foldedAxis, 6.0, 194.0);
    }
    CoverageWall wall;
    std::shared_ptr<const WallRays> rays;
};

TEST(CoverageReview, VisitsWhatTheFlightHasMissed) {
    Folded folded;
    const SightTree tree(WallRays::of(folded.wall.mesh).value());
    const Eyepiece eyepiece = Eyepiece::of(PinholePicture{90.0, 160});
    std::vector<Visibility> seen(folded.wall.mesh.triangles.size(), Visibility::unseen);
    ASSERT_TRUE(look(tree, eyepiece,
                     flightCameras(folded.wall.centerline, 60, FlightDirection::antegrade), seen));
    const double leastMm2 = 60.0;
    const auto before = folded.wall.missed(seen);
    ASSERT_GT(before.size(), 3u);
    ASSERT_GT(before.front().areaMm2, leastMm2);
    const double shareBefore = shareOf(folded.wall, seen).areaPercent();
    const auto review = reviewMissed(tree, folded.wall, eyepiece, leastMm2, seen, {});
    ASSERT_TRUE(review);
    EXPECT_GT(review->patches, 0);
    EXPECT_EQ(review->cameras.size(), std::size_t(review->patches));
    EXPECT_GT(shareOf(folded.wall, seen).areaPercent(), shareBefore + 5.0);
    const auto after = folded.wall.missed(seen);
    if (!after.empty()) {
        EXPECT_LT(after.front().areaMm2, leastMm2);
    }
}

TEST(CoveragePlan, LeavesLessBlindThanTheCenterline) {
    Folded folded;
    const SightTree tree(WallRays::of(folded.wall.mesh).value());
    const PinholePicture picture{90.0, 128};
    const Eyepiece eyepiece = Eyepiece::of(picture);
    const auto shareOfCameras = [&](std::span<const CenterlineCamera> cameras) {
        std::vector<Visibility> seen(folded.wall.mesh.triangles.size(), Visibility::unseen);
        EXPECT_TRUE(look(tree, eyepiece, cameras, seen));
        return shareOf(folded.wall, seen).areaPercent();
    };
    double before = 0.0;
    for (const int count : {10, 24, 60}) {
        const auto planned = plannedCameras(tree, folded.wall, picture, count, {.trialSide = 64});
        ASSERT_TRUE(planned);
        EXPECT_LE(planned->size(), std::size_t(count));
        auto line = flightCameras(folded.wall.centerline, count / 2, FlightDirection::antegrade);
        const auto back =
            flightCameras(folded.wall.centerline, count / 2, FlightDirection::retrograde);
        line.insert(line.end(), back.begin(), back.end());
        const double share = shareOfCameras(*planned);
        EXPECT_GT(share, shareOfCameras(line) + 0.5) << count;
        EXPECT_GT(share, before);
        before = share;
        const auto again =
            plannedCameras(tree, folded.wall, picture, count, {.trialSide = 64, .threads = 3});
        ASSERT_TRUE(again);
        ASSERT_EQ(again->size(), planned->size());
        double arc = 0.0;
        for (std::size_t n = 0; n < planned->size(); ++n) {
            EXPECT_EQ((*again)[n].positionMm, (*planned)[n].positionMm);
            const double here = nearestArc(folded.wall.centerline, (*planned)[n].positionMm);
            EXPECT_GT(here, arc - 25.0) << "along the colon";
            arc = here;
        }
    }
}

TEST(CoverageReportText, TellsEachTrianglesVisibilityAndRefusesOtherTexts) {
    Folded folded;
    std::vector<Visibility> seen;
    for (std::size_t n = 0; n < folded.wall.mesh.triangles.size(); ++n) {
        seen.push_back(Visibility(n * 7 % 3));
        folded.wall.bridged[n] = n % 11 == 5;
    }
    CoverageReport report;
    report.mode = "vc";
    report.share = shareOf(folded.wall, seen);
    report.missed = folded.wall.missed(seen);
    const std::string text = coverageJson(report, folded.wall, seen);
    const auto flags = triangleFlagsOf(text, seen.size());
    ASSERT_TRUE(flags) << describe(flags.error());
    double seenMm2 = 0.0, allMm2 = 0.0;
    for (std::size_t n = 0; n < seen.size(); ++n) {
        EXPECT_EQ((*flags)[n], folded.wall.bridged[n] ? 3 : int(seen[n]));
        if (folded.wall.bridged[n]) continue;
        allMm2 += tests::triangleAreaMm2(folded.wall.mesh, n);
        if (seen[n] != Visibility::unseen) seenMm2 += tests::triangleAreaMm2(folded.wall.mesh, n);
    }
    EXPECT_NEAR(report.share.areaPercent(), 100.0 * seenMm2 / allMm2, 1e-9);
    EXPECT_FALSE(triangleFlagsOf(text, seen.size() + 1));
    EXPECT_FALSE(triangleFlagsOf(coverageJson(report), seen.size()));
    EXPECT_FALSE(triangleFlagsOf("{}", seen.size()));
    EXPECT_FALSE(triangleFlagsOf("no JSON", seen.size()));
}

// Two loops side by side: the wall that the flat map has is of its own loop, though the other's
// centerline is nearer.
TEST(CoverageSegments, FollowTheFlatMapWhereItHasTheWall) {
    CoverageWall wall;
    wall.mesh.vertices = {{11, 0, 30}, {11, 1, 30}, {11, 0, 31}};
    wall.mesh.triangles = {{0, 1, 2}, {0, 1, 2}};
    for (int mm = 0; mm <= 100; ++mm)
        wall.centerline.points.push_back({{0, 0, mm}, double(mm), 10.0, false});
    for (int mm = 0; mm <= 100; ++mm)
        wall.centerline.points.push_back({{20, 0, 100 - mm}, 120.0 + mm, 10.0, false});
    FlatMap map;
    map.surface = {wall.mesh.vertices, {{0, 1, 2}}};
    map.flat.resize(3);
    map.camera = {0, 0, 1};
    map.sourceTriangle = {1};
    map.cameras = {{{0, 0, 30}, 30.0}, {{0, 0, 33}, 33.0}};
    const auto arcs = arcsOf(wall, {0, 1}, &map, 1);
    EXPECT_NEAR(arcs[0], 190.0, 0.6) << "the map lacks it";
    EXPECT_NEAR(arcs[1], 31.0, 1e-9);
    const auto segments =
        segmentsOf(arcs, {{0.0, ColonSegment::sigmoid}, {110.0, ColonSegment::transverse}});
    EXPECT_EQ(segments, (std::vector{ColonSegment::transverse, ColonSegment::sigmoid}));
    EXPECT_EQ(arcsOf(wall, {0, 1}, nullptr, 1)[1], arcs[0]);
    EXPECT_TRUE(segmentsOf(arcs, {}).empty());
}

}  // namespace
}  // namespace haustra::coverage
