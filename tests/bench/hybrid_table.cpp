// The hybrid and the polygon-assisted raycaster beside the single pass: the dissertation's Tables
// 5.2 and 5.3 as ratios, what each control gains, and what mesh entry points gain in a colon.
#include "cli/input_volume.h"
#include "core/centerline.h"
#include "render/gl/single_pass_raycaster.h"
#include "render/hybrid/hybrid_raycaster.h"
#include "render/optics/optics_presets.h"
#include "render/wall/polygon_assisted_raycaster.h"
#include "stopwatch.h"
#include "store/case_store.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

namespace {

using namespace haustra;
using namespace render;

using bench::cpuMilliseconds, bench::milliseconds;

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0.0 : values[values.size() / 2];
}

template <class T>
T orEnd(Result<T> made) {
    if (made) return std::move(*made);
    fmt::print(stderr, "hybrid_table: {}\n", describe(made.error()));
    std::exit(1);
}

struct Times {
    std::vector<double> ms, cpuMs;
    Image last;

    void draw(Raycaster& raycaster, const CameraView& view, int side) {
        last = {side, side, std::vector<std::uint8_t>(3 * std::size_t(side) * std::size_t(side))};
        const double start = milliseconds(), cpu = cpuMilliseconds();
        if (const auto done = raycaster.render(view, Band::whole(side, side), last); !done) {
            fmt::print(stderr, "hybrid_table: {}\n", describe(done.error()));
            std::exit(1);
        }
        ms.push_back(milliseconds() - start);
        cpuMs.push_back(cpuMilliseconds() - cpu);
    }
};

int apart(const Image& a, const Image& b) {
    int most = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i)
        most = std::max(most, std::abs(int(a.rgb[i]) - int(b.rgb[i])));
    return most;
}

/// From around the volume, which fills the picture.
std::vector<CameraView> around(const Grid& grid, const Optics& optics, int views) {
    const glm::dvec3 middle = grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size - 1));
    const double reach = glm::distance(middle, grid.patientFromVoxelPoint(glm::dvec3(0.0)));
    std::vector<CameraView> made;
    for (int i = 0; i < views; ++i) {
        const double turn = 2.0 * 3.14159265 * (i + 0.3) / views;
        const glm::dvec3 along = glm::normalize(glm::dvec3(std::cos(turn), std::sin(turn), -0.3));
        CameraView view;
        view.camera = {middle - 2.2 * reach * along, along, {0.0, 0.0, 1.0}, 45.0};
        view.optics = optics;
        view.optics.light.halfDepthMm = 1e6;  // a lamp at the camera would leave it dark
        made.push_back(view);
    }
    return made;
}

struct Setup {
    const char* name;
    std::optional<HybridControls> controls;
};

/// Balanced; with all that the CPU can do; and that without each control.
std::vector<Setup> setups() {
    return {{"balanced", std::nullopt},
            {"all that the CPU can do", HybridControls{0, true, 0, 0.0}},
            {"  1: begins at level 3", HybridControls{3, false, 0, 0.0}},
            {"  2: not to the boundary", HybridControls{0, false, 0, 0.0}},
            {"  3: no way from behind", HybridControls{0, true, -1, 0.0}},
            {"  4: tiles left at 1/4", HybridControls{0, true, 0, 0.25}},
            {"  4: not followed at all", HybridControls{0, true, 0, 1.01}},
            {"least (rung 0)", hybridLadder[0]}};
}

void hybridTable(gpu::Context& context, const std::string& name, Volume<std::int16_t> volume,
                 const std::string& preset, int side, int places) {
    Scene made;
    made.ranges = blockRanges(volume, 0);
    made.volume = std::move(volume);
    const auto scene = std::shared_ptr<GlScene>(
        orEnd(GlScene::upload(context, std::make_shared<const Scene>(std::move(made)), 0)));
    const auto single = orEnd(SinglePassRaycaster::create(scene));
    const auto views = around(scene->scene().grid(), orEnd(opticsPreset(preset)), places);
    fmt::print("{} {}, {}²: median ms a picture (CPU time), and the single pass's / it\n", name,
               preset, side);
    for (const Setup& setup : setups()) {
        const auto hybrid = orEnd(HybridRaycaster::create(scene, {0, setup.controls}));
        // The balance needs some pictures to find its place.
        Times warm;
        for (int i = 0; i < (setup.controls ? 1 : 32); ++i)
            warm.draw(*hybrid, views.front(), side);
        warm.draw(*single, views.front(), side);
        Times plain, shared;
        std::vector<double> cpu, gpu;
        int most = 0;
        double cast = 0.0, filled = 0.0, passes = 0.0;
        for (const CameraView& view : views) {
            plain.draw(*single, view, side);
            shared.draw(*hybrid, view, side);
            most = std::max(most, apart(plain.last, shared.last));
            const HybridStats& stats = hybrid->stats();
            cpu.push_back(stats.cpuMs);
            gpu.push_back(stats.gpuMs);
            cast += double(stats.quadsCast) / stats.quads / places;
            filled += double(stats.quadsFilled) / stats.quads / places;
            passes += double(stats.passes) / places;
        }
        fmt::print(
            "{:26s} single {:6.1f} ({:6.1f})  hybrid {:6.1f} ({:6.1f})  ratio {:.2f} "
            "({:.2f})  cpu {:6.1f} gpu {:6.1f}  passes {:4.1f} quads {:.2f} + {:.2f} "
            "filled, most apart {}, rung {} {} {} {}\n",
            setup.name, median(plain.ms), median(plain.cpuMs), median(shared.ms),
            median(shared.cpuMs), median(plain.ms) / median(shared.ms),
            median(plain.cpuMs) / median(shared.cpuMs), median(cpu), median(gpu), passes, cast,
            filled, most, hybrid->stats().controls.entryLevel, hybrid->stats().controls.toBoundary,
            hybrid->stats().controls.exitLevel, hybrid->stats().controls.leftToFilling);
    }
}

void polygonTable(gpu::Context& context, const store::Case& source, const std::string& preset,
                  int places) {
    Scene made;
    const auto products = orEnd(source.products());
    const bool cleansed =
        std::any_of(products.begin(), products.end(),
                    [](const store::ProductEntry& entry) { return entry.product == "cleansed"; });
    made.volume = orEnd(source.readVolume<std::int16_t>(cleansed ? "cleansed" : "ct"));
    made.ranges = blockRanges(made.volume, 0);
    made.wall = std::make_shared<const TriMesh>(orEnd(source.readMesh()));
    const Centerline path = orEnd(source.readCenterline());
    const auto scene = std::shared_ptr<GlScene>(
        orEnd(GlScene::upload(context, std::make_shared<const Scene>(std::move(made)), 0)));
    const auto single = orEnd(SinglePassRaycaster::create(scene));
    const double before = milliseconds();
    const auto assisted = orEnd(PolygonAssistedRaycaster::create(scene, 0));
    fmt::print("a colon of {} triangles, {}; made ready in {:.0f} ms\n",
               scene->scene().wall->triangles.size(), preset, milliseconds() - before);
    const auto hybrid = orEnd(HybridRaycaster::create(scene));
    const auto ups = rotationMinimizingUps(path, flightPreferredUp);
    const Optics optics = orEnd(opticsPreset(preset));
    for (const int side : {256, 512, 1024}) {
        Times plain, meshed, shared;
        std::vector<double> mesh;
        int began = 0, most = 0, differ = 0;
        for (int i = -1; i < places; ++i) {
            const CenterlineCamera at =
                cameraAtArc(path, ups, path.lengthMm() * (std::max(i, 0) + 0.5) / places,
                            FlightDirection::antegrade);
            CameraView view;
            view.camera = {at.positionMm, at.forward, at.up, 90.0};
            view.optics = optics;
            if (i == 0) plain = meshed = shared = {};
            plain.draw(*single, view, side);
            meshed.draw(*assisted, view, side);
            shared.draw(*hybrid, view, side);
            if (i < 0) continue;
            if (const auto times = assisted->passTimes(); !times.empty())
                mesh.push_back(times.front().ms);
            began += assisted->beganAtMesh();
            most = std::max(most, apart(plain.last, meshed.last));
            differ = std::max(differ, apart(plain.last, shared.last));
        }
        fmt::print(
            "{:5d}²  single {:6.1f} ({:6.1f})  polygon-assisted {:6.1f} ({:6.1f}), of it "
            "the mesh {:5.1f}, most apart {}  hybrid {:6.1f} ({:6.1f}), most apart {};  "
            "{} of {} began at the mesh, {} blocks before it\n",
            side, median(plain.ms), median(plain.cpuMs), median(meshed.ms), median(meshed.cpuMs),
            median(mesh), most, median(shared.ms), median(shared.cpuMs), differ, began, places,
            assisted->blocksBefore());
    }
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App program("Times the hybrid and the polygon-assisted raycaster beside the single pass.");
    std::string volumes, storeFolder, caseName;
    int side = 512, places = 9;
    program.add_option("--volumes", volumes, "Folder of engine, bonsai and head");
    program.add_option("--store", storeFolder, "A store with a prepared case");
    program.add_option("--case", caseName, "Its name");
    program.add_option("--size", side, "Pixels")->check(CLI::Range(1, 2048));
    program.add_option("--places", places, "Views")->check(CLI::Range(1, 1000));
    CLI11_PARSE(program, argc, argv);
    // Lines appear as they are made, also in a file.
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    const auto context = orEnd(gpu::Context::create());
    fmt::print("{} ({})\n", context->renderer(), context->platform());
    if (!storeFolder.empty()) {
        const auto source =
            orEnd(store::CaseStore::open(storeFolder, false).and_then([&](const auto& s) {
                return s.openCase(caseName);
            }));
        for (const char* preset : {"mucosa", "biopsy"})
            polygonTable(*context, source, preset, places);
    }
    if (volumes.empty()) return 0;
    const std::filesystem::path folder = volumes;
    struct Data {
        const char* name;
        std::filesystem::path path;
        glm::dvec3 spacingMm;
    };
    for (const Data& data :
         {Data{"engine", folder / "engine.nii.gz", glm::dvec3(1.0)},
          Data{"bonsai", folder / "bonsai.nii.gz", glm::dvec3(1.0)},
          Data{"head", folder / "visible_human_ct_head" / "texture", {1.0, 1.0, -1.0}}}) {
        if (!std::filesystem::exists(data.path)) continue;
        for (const char* kind : {"opaque", "translucent"})
            hybridTable(*context, data.name,
                        orEnd(cli::readInputVolume(data.path, data.spacingMm, 0)),
                        std::string(data.name) + "-" + kind, side, places);
    }
    return 0;
}
