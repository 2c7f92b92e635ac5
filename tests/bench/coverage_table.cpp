// The dissertation's table 2.2 on prepared cases: shares of the wall's area, mean and spread.
// usage: coverage_table STORE CASE…
//        coverage_table STORE --why CASE…     the optical row again with one assumption changed
//        each
#include "core/bridges.h"
#include "coverage/corner_path.h"
#include "coverage/coverage_report.h"
#include "coverage/fine_wall.h"
#include "coverage/sight.h"
#include "stopwatch.h"
#include "store/case_store.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace haustra;
using namespace haustra::coverage;

using Seen = std::vector<Visibility>;

struct Column {
    const char* name;
    std::vector<double> percent = {};
};

void say(const char* name, const std::vector<Column>& columns) {
    std::printf("%-16s", name);
    for (const Column& column : columns)
        std::printf(" %9.2f", column.percent.back());
    std::printf("\n");
    std::fflush(stdout);
}

/// A case as the rows see it.
struct Colon {
    CoverageWall wall;
    std::unique_ptr<SightTree> tree;
    CornerPath corner;

    double percentOf(const Eyepiece& eyepiece, const std::vector<CenterlineCamera>& cameras) const {
        Seen seen(wall.mesh.triangles.size(), Visibility::unseen);
        return look(*tree, eyepiece, cameras, seen) ? shareOf(wall, seen).areaPercent() : 0.0;
    }
};

Result<Colon> readColon(const store::CaseStore& store, const std::string& name, bool fine = true) {
    const auto source = TRY(store.openCase(name));
    Colon colon;
    CoverageWall& wall = colon.wall;
    wall.mesh = TRY(source.readMesh());
    if (fine) wall.mesh = fineWall(wall.mesh).mesh;
    wall.neighbours = neighboursOf(wall.mesh);
    wall.bridged = bridgedTriangles(wall.mesh, TRY(source.readVolume<std::uint8_t>("lumen")));
    wall.centerline = TRY(source.readCenterline());
    colon.tree = std::make_unique<SightTree>(TRY(WallRays::of(wall.mesh, wall.bridged)));
    colon.corner = TRY(cornerPath(TRY(source.readVolume<float>("distance")), wall.centerline,
                                  olympusCfQ160l().tipRadiusMm));
    return colon;
}

Result<void> why(const store::CaseStore& store, const std::string& name) {
    constexpr int count = 1000;
    const Colon colon = TRY(readColon(store, name));
    const auto say = [&](const char* what, double percent) {
        std::printf("%-16s %-60s %7.2f\n", name.c_str(), what, percent);
        std::fflush(stdout);
    };
    const auto there = FlightDirection::antegrade;
    const auto cameras = scopeCameras(colon.corner.path, count, there);
    const auto optical = [&](const Colonoscope& scope) {
        return colon.percentOf(Eyepiece::of(scope), cameras);
    };
    const Colonoscope scope = olympusCfQ160l();
    say("optical, 1000 cameras", optical(scope));
    Colonoscope other = scope;
    other.farthestMm = 1000.0;
    say("sharp however far", optical(other));
    other = scope;
    other.nearestMm = 0.0;
    say("sharp however near", optical(other));
    other = scope;
    other.openRadii = {1000.0, 1000.0};
    other.fieldDegrees = 180.0;
    say("the whole picture open, not the ellipse", optical(other));
    say("on the centerline, along its tangent",
        colon.percentOf(Eyepiece::of(scope), scopeCameras(colon.wall.centerline, count, there)));
    say("on the centerline, looking 20 mm ahead",
        colon.percentOf(Eyepiece::of(scope), flightCameras(colon.wall.centerline, count, there)));
    say("on the path that hugs corners, looking 20 mm ahead",
        colon.percentOf(Eyepiece::of(scope), flightCameras(colon.corner.path, count, there)));
    const Colon coarse = TRY(readColon(store, name, false));
    say("triangles of the simplified surface, not halved",
        coarse.percentOf(Eyepiece::of(scope), cameras));
    say("virtual one way, triangles not halved",
        coarse.percentOf(Eyepiece::of(PinholePicture{}),
                         flightCameras(coarse.wall.centerline, count, there)));
    PinholePicture half;
    half.side = 256;
    say("virtual one way, 256 pixels",
        colon.percentOf(Eyepiece::of(half), flightCameras(colon.wall.centerline, count, there)));
    say("virtual one way, 512 pixels",
        colon.percentOf(Eyepiece::of(PinholePicture{}),
                        flightCameras(colon.wall.centerline, count, there)));
    return {};
}

Result<void> add(const store::CaseStore& store, const std::string& name,
                 std::vector<Column>& columns) {
    const Colon colon = TRY(readColon(store, name));
    const CoverageWall& wall = colon.wall;
    const SightTree& tree = *colon.tree;
    const CornerPath& corner = colon.corner;
    const Eyepiece fisheye = Eyepiece::of(olympusCfQ160l()),
                   pinhole = Eyepiece::of(PinholePicture{});
    std::size_t column = 0;
    const auto keep = [&](const Seen& seen) {
        columns[column++].percent.push_back(shareOf(wall, seen).areaPercent());
    };
    const auto lookFrom = [&](const Eyepiece& eyepiece,
                              std::vector<CenterlineCamera> cameras) -> Result<Seen> {
        Seen seen(wall.mesh.triangles.size(), Visibility::unseen);
        TRY(look(tree, eyepiece, cameras, seen));
        return seen;
    };
    const auto there = FlightDirection::antegrade, back = FlightDirection::retrograde;
    for (const int count : {1000, 2000})
        keep(TRY(lookFrom(fisheye, scopeCameras(corner.path, count, there))));
    keep(TRY(lookFrom(fisheye, scopeCameras(corner.path, 1000, back))));
    std::vector<Seen> both;
    for (const int count : {1000, 2000}) {
        const Seen retrograde = TRY(lookFrom(pinhole, flightCameras(wall.centerline, count, back)));
        keep(retrograde);
        both.push_back(TRY(lookFrom(pinhole, flightCameras(wall.centerline, count, there))));
        addSeen(both.back(), retrograde);
    }
    for (const Seen& seen : both)
        keep(seen);
    // Cameras that look along the centerline's tangent instead of where it will be.
    Seen tangents = TRY(lookFrom(pinhole, scopeCameras(wall.centerline, 1000, back)));
    keep(tangents);
    addSeen(tangents, TRY(lookFrom(pinhole, scopeCameras(wall.centerline, 1000, there))));
    keep(tangents);
    TRY(reviewMissed(tree, wall, pinhole, leastReviewedMm2, both.front(), {}));
    keep(both.front());
    columns[column++].percent.push_back(corner.narrowMm);
    columns[column++].percent.push_back(corner.path.lengthMm());
    columns[column++].percent.push_back(wall.centerline.lengthMm());
    columns[column++].percent.push_back(1e-3 * double(wall.mesh.triangles.size()));
    columns[column++].percent.push_back(1e-2 * shareOf(wall, both.front()).areaMm2);
    return {};
}

Result<void> run(const std::string& folder, const std::vector<std::string>& names) {
    const auto store = TRY(store::CaseStore::open(folder, false));
    if (names.front() == "--why") {
        for (std::size_t n = 1; n < names.size(); ++n)
            TRY(why(store, names[n]));
        return {};
    }
    std::vector<Column> columns{{"oc1000"},   {"oc2000"},  {"oc1000r"},  {"vcr1000"},  {"vcr2000"},
                                {"vcb1000"},  {"vcb2000"}, {"tanr1000"}, {"tanb1000"}, {"reviewed"},
                                {"narrowMm"}, {"pathMm"},  {"lineMm"},   {"ktriang"},  {"cm2"}};
    std::printf("%-16s", "");
    for (const Column& column : columns)
        std::printf(" %9s", column.name);
    std::printf("\n");
    for (const std::string& name : names) {
        TRY(add(store, name, columns));
        say(name.c_str(), columns);
    }
    std::vector<Column> means = columns, spreads = columns;
    for (std::size_t n = 0; n < columns.size(); ++n) {
        const auto& values = columns[n].percent;
        double mean = 0.0, square = 0.0;
        for (const double value : values)
            mean += value / double(values.size());
        for (const double value : values)
            square += (value - mean) * (value - mean);
        means[n].percent = {mean};
        spreads[n].percent = {values.size() > 1 ? std::sqrt(square / double(values.size() - 1))
                                                : 0.0};
    }
    say("mean", means);
    say("sd", spreads);
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: coverage_table STORE [--why] CASE...\n");
        return 2;
    }
    const auto done = run(argv[1], {argv + 2, argv + argc});
    if (!done) std::fprintf(stderr, "%s\n", describe(done.error()).c_str());
    return done ? 0 : 1;
}
