// Times simulated colonoscopies of a prepared case, and holds the fast search against every ray.
// usage: coverage_bench STORE CASE [CAMERAS [CHECKED]]
#include "core/bridges.h"
#include "coverage/corner_path.h"
#include "coverage/fine_wall.h"
#include "coverage/sight.h"
#include "stopwatch.h"
#include "store/case_store.h"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using namespace haustra;
using namespace haustra::coverage;

struct Clock {
    double wall = bench::milliseconds(), cpu = bench::cpuMilliseconds();
    void print(const char* what, double per = 0.0) const {
        const double w = bench::milliseconds() - wall, c = bench::cpuMilliseconds() - cpu;
        std::printf("%-44s %8.2f s, processor %8.2f s", what, w / 1e3, c / 1e3);
        if (per > 0.0) std::printf("  %7.2f ms, processor %7.2f ms each", w / per, c / per);
        std::printf("\n");
        std::fflush(stdout);
    }
};

void print(const char* what, const TriMesh& mesh, const std::vector<std::uint8_t>& bridged,
           const std::vector<Visibility>& seen) {
    double all = 0.0, part = 0.0, full = 0.0;
    long triangles = 0, observed = 0;
    for (std::size_t n = 0; n < seen.size(); ++n) {
        if (bridged[n]) continue;
        const glm::ivec3 t = mesh.triangles[n];
        const glm::dvec3 a = mesh.vertices[std::size_t(t.x)];
        const double area = 0.5 * glm::length(glm::cross(mesh.vertices[std::size_t(t.y)] - a,
                                                         mesh.vertices[std::size_t(t.z)] - a));
        all += area, ++triangles;
        if (seen[n] == Visibility::unseen) continue;
        part += area, ++observed;
        if (seen[n] == Visibility::fully) full += area;
    }
    std::printf("  %s: %.2f %% of area, %.2f %% of triangles; fully %.2f %%\n", what,
                100.0 * part / all, 100.0 * observed / triangles, 100.0 * full / all);
}

Result<void> run(const std::string& folder, const std::string& name, int count, int checked) {
    const auto source = TRY(store::CaseStore::open(folder, false).and_then([&](const auto& s) {
        return s.openCase(name);
    }));
    const auto surface = TRY(source.readMesh());
    const auto centerline = TRY(source.readCenterline());
    const auto distance = TRY(source.readVolume<float>("distance"));
    const auto lumen = TRY(source.readVolume<std::uint8_t>("lumen"));
    Clock start;
    const FineWall fine = fineWall(surface);
    start.print("fine wall");
    std::printf("%zu triangles, %zu fine ones; centerline %.0f mm\n", surface.triangles.size(),
                fine.mesh.triangles.size(), centerline.lengthMm());
    const auto bridged = bridgedTriangles(fine.mesh, lumen);
    start = {};
    const auto rays = TRY(WallRays::of(fine.mesh, bridged));
    start.print("rays");
    start = {};
    const SightTree tree(rays);
    start.print("tree");
    start = {};
    const auto corner = TRY(cornerPath(distance, centerline, olympusCfQ160l().tipRadiusMm));
    start.print("path");
    std::printf("path %.1f mm, %.1f mm narrow\n", corner.path.lengthMm(), corner.narrowMm);

    struct Mode {
        std::string name;
        Eyepiece eyepiece;
        std::vector<CenterlineCamera> cameras;
        bool tellFully;
    };
    const auto both = [&](auto cameras, const Centerline& path) {
        auto all = cameras(path, count, FlightDirection::antegrade);
        const auto back = cameras(path, count, FlightDirection::retrograde);
        all.insert(all.end(), back.begin(), back.end());
        return all;
    };
    const Eyepiece scope = Eyepiece::of(olympusCfQ160l()), pinhole = Eyepiece::of(PinholePicture{});
    const auto ante = FlightDirection::antegrade, retro = FlightDirection::retrograde;
    const Mode modes[] = {
        {"oc towards cecum", scope, scopeCameras(corner.path, count, ante), false},
        {"oc towards rectum", scope, scopeCameras(corner.path, count, retro), false},
        {"vc antegrade", pinhole, flightCameras(centerline, count, ante), true},
        {"vc retrograde", pinhole, flightCameras(centerline, count, retro), true},
        {"vc both", pinhole, both(flightCameras, centerline), true},
        {"vc both, tangents", pinhole, both(scopeCameras, centerline), true},
    };
    for (const Mode& mode : modes) {
        std::vector<Visibility> seen(fine.mesh.triangles.size(), Visibility::unseen);
        start = {};
        TRY(look(tree, mode.eyepiece, mode.cameras, seen, {.tellFully = mode.tellFully}));
        start.print(mode.name.c_str(), double(mode.cameras.size()));
        print("seen", fine.mesh, bridged, seen);
        if (checked == 0) continue;
        std::vector<CenterlineCamera> few;
        for (int n = 0; n < checked; ++n)
            few.push_back(
                mode.cameras[mode.cameras.size() * std::size_t(n) / std::size_t(checked)]);
        std::vector<Visibility> fast(seen.size()), every(seen.size());
        start = {};
        TRY(look(tree, mode.eyepiece, few, fast, {.tellFully = mode.tellFully, .threads = 1}));
        start.print("  few, searched", checked);
        start = {};
        lookByEveryRay(*rays, mode.eyepiece, few, every, mode.tellFully);
        start.print("  few, every ray", checked);
        start = {};
        for (const CenterlineCamera& camera : few)
            trianglesSeen(*rays, mode.eyepiece, camera);
        start.print("  few, packets", checked);
        long differ = 0;
        for (std::size_t n = 0; n < seen.size(); ++n)
            differ += fast[n] != every[n];
        std::printf("  %ld triangles differ\n", differ);
    }
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: coverage_bench STORE CASE [CAMERAS [CHECKED]]\n");
        return 2;
    }
    const auto done = run(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : 1000,
                          argc > 4 ? std::atoi(argv[4]) : 8);
    if (!done) std::fprintf(stderr, "%s\n", describe(done.error()).c_str());
    return done ? 0 : 1;
}
