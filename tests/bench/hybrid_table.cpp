// The hybrid and the polygon-assisted raycaster beside the single pass: the dissertation's Tables
// 5.2 and 5.3 as ratios, what each control gains, and what mesh entry points gain in a colon.
#include "cli/input_volume.h"
#include "core/centerline.h"
#include "render/gl/single_pass_raycaster.h"
#include "render/hybrid/hybrid_raycaster.h"
#include "render/optics/optics_presets.h"
#include "render/polygon_assisted/polygon_assisted_raycaster.h"
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
    std::string name;
    std::optional<HybridControls> controls;
};

/// The lowest split; balanced; with all that the CPU can do; and that without each control.
std::vector<Setup> setups() {
    return {{"least work for the CPU (split 0)", hybridSplits[0]},
            {"balanced", std::nullopt},
            {"all that the CPU can do", HybridControls{0, true, 0, 0.0}},
            {"… 1: rays begin at level 3", HybridControls{3, false, 0, 0.0}},
            {"… 2: not to the boundary", HybridControls{0, false, 0, 0.0}},
            {"… 3: no way from behind", HybridControls{0, true, -1, 0.0}},
            {"… 4: tiles left at a quarter", HybridControls{0, true, 0, 0.25}},
            {"… 4: not followed", HybridControls{0, true, 0, 1.01}}};
}

/// Every split, and where the balance comes to stand.
std::vector<Setup> splits() {
    std::vector<Setup> splits = {{"balanced", std::nullopt}};
    for (std::size_t split = 0; split < hybridSplits.size(); ++split)
        splits.push_back({fmt::format("split {}", split), hybridSplits[split]});
    return splits;
}

/// "-" for controls that are none of these.
char splitOf(const HybridControls& controls) {
    const auto found = std::find(hybridSplits.begin(), hybridSplits.end(), controls);
    return found == hybridSplits.end() ? '-' : char('0' + (found - hybridSplits.begin()));
}

/// What one setup has cost, picture by picture.
struct Cost {
    std::unique_ptr<HybridRaycaster> raycaster;
    Times times;
    std::vector<double> cpu, gpu;
    double cast = 0.0, filled = 0.0, passes = 0.0;
    int most = 0;
};

/// Medians of one volume with one transfer function.
struct Column {
    std::string name;
    double singleMs = 0.0, singleCpuMs = 0.0;
    std::vector<double> ms, cpuMs;  // of each setup
};

struct Sizes {
    int side, places, rounds, warm;
};

/// Single pass and all setups in turns: what else runs on the machine meets all of them.
Column measure(gpu::Context& context, const std::string& name, Volume<std::int16_t> volume,
               const std::vector<Setup>& setups, const Sizes& sizes) {
    Scene made;
    made.ranges = blockRanges(volume, blockSide, 0);
    made.volume = std::move(volume);
    const auto scene = std::shared_ptr<GlScene>(
        orEnd(GlScene::upload(context, std::make_shared<const Scene>(std::move(made)), 0)));
    const auto single = orEnd(SinglePassRaycaster::create(scene));
    const auto views = around(scene->scene().grid(), orEnd(opticsPreset(name)), sizes.places);
    Times plain;
    plain.draw(*single, views.front(), sizes.side);
    plain = {};
    std::vector<Cost> costs(setups.size());
    for (std::size_t i = 0; i < setups.size(); ++i) {
        costs[i].raycaster = orEnd(HybridRaycaster::create(scene, {0, setups[i].controls}));
        // The balance needs some pictures to find its place.
        Times warm;
        std::string splits;
        for (int n = 0; n < (setups[i].controls ? 1 : sizes.warm); ++n) {
            warm.draw(*costs[i].raycaster, views.front(), sizes.side);
            splits += splitOf(costs[i].raycaster->stats().controls);
        }
        if (!setups[i].controls)
            fmt::print("{}: splits while the balance finds its place {}\n", name, splits);
    }
    const double pictures = sizes.places * sizes.rounds;
    for (const CameraView& view : views) {
        for (int round = 0; round < sizes.rounds; ++round) {
            plain.draw(*single, view, sizes.side);
            for (Cost& cost : costs) {
                cost.times.draw(*cost.raycaster, view, sizes.side);
                cost.most = std::max(cost.most, apart(plain.last, cost.times.last));
                const HybridStats& stats = cost.raycaster->stats();
                cost.cpu.push_back(stats.cpuMs);
                cost.gpu.push_back(stats.gpuMs);
                cost.cast += double(stats.quadsCast) / stats.quads / pictures;
                cost.filled += double(stats.quadsFilled) / stats.quads / pictures;
                cost.passes += double(stats.passes) / pictures;
            }
        }
    }
    Column column{name, median(plain.ms), median(plain.cpuMs), {}, {}};
    fmt::print("{}, {}²: single pass {:.1f} ms, CPU time {:.1f} ms\n", name, sizes.side,
               column.singleMs, column.singleCpuMs);
    for (std::size_t i = 0; i < setups.size(); ++i) {
        const Cost& cost = costs[i];
        column.ms.push_back(median(cost.times.ms));
        column.cpuMs.push_back(median(cost.times.cpuMs));
        fmt::print(
            "  {:32s} {:6.1f} ms, CPU time {:6.1f} ms; cpu {:6.1f} gpu {:6.1f}, passes {:4.1f}, "
            "quads {:.2f} + {:.2f} filled, most apart {}, split {}\n",
            setups[i].name, column.ms.back(), column.cpuMs.back(), median(cost.cpu),
            median(cost.gpu), cost.passes, cost.cast, cost.filled, cost.most,
            splitOf(cost.raycaster->stats().controls));
    }
    return column;
}

/// The single pass's milliseconds, and what they are of each setup's: over 1 where the hybrid is
/// faster.
void printTable(const char* what, const std::vector<Setup>& setups,
                const std::vector<Column>& columns, double Column::*single,
                std::vector<double> Column::*hybrid) {
    fmt::print("\n| {} |", what);
    for (const Column& column : columns)
        fmt::print(" {} |", column.name);
    fmt::print("\n| --- |");
    for (std::size_t i = 0; i < columns.size(); ++i)
        fmt::print(" --- |");
    fmt::print("\n| single pass, ms |");
    for (const Column& column : columns)
        fmt::print(" {:.0f} |", column.*single);
    for (std::size_t i = 0; i < setups.size(); ++i) {
        fmt::print("\n| {} |", setups[i].name);
        for (const Column& column : columns)
            fmt::print(" {:.2f} |", column.*single / (column.*hybrid)[i]);
    }
    fmt::print("\n");
}

void polygonTable(gpu::Context& context, const store::Case& source, const std::string& preset,
                  int places) {
    Scene made;
    const auto products = orEnd(source.products());
    const bool cleansed =
        std::any_of(products.begin(), products.end(),
                    [](const store::ProductEntry& entry) { return entry.product == "cleansed"; });
    made.volume = orEnd(source.readVolume<std::int16_t>(cleansed ? "cleansed" : "ct"));
    made.ranges = blockRanges(made.volume, blockSide, 0);
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
    std::string volumes, storeFolder, caseName, only;
    int side = 512, places = 3, rounds = 2, warm = 48;
    bool everySplit = false;
    program.add_option("--volumes", volumes, "Folder of engine, bonsai and head");
    program.add_option("--store", storeFolder, "A store with a prepared case");
    program.add_option("--case", caseName, "Its name");
    program.add_option("--size", side, "Pixels")->check(CLI::Range(1, 2048));
    program.add_option("--places", places, "Views")->check(CLI::Range(1, 1000));
    program.add_option("--rounds", rounds, "Pictures of each view")->check(CLI::Range(1, 1000));
    program.add_option("--warm", warm, "Pictures in which the balance finds its place")
        ->check(CLI::Range(1, 100000));
    program.add_option("--only", only, "One of the volumes");
    program.add_flag("--splits", everySplit,
                     "Every split of the balance, in place of the controls");
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
    const std::vector<Setup> chosen = everySplit ? splits() : setups();
    std::vector<Column> columns;
    struct Data {
        const char* name;
        std::filesystem::path path;
        glm::dvec3 spacingMm;
    };
    for (const Data& data :
         {Data{"engine", folder / "engine.nii.gz", glm::dvec3(1.0)},
          Data{"bonsai", folder / "bonsai.nii.gz", glm::dvec3(1.0)},
          Data{"head", folder / "visible_human_ct_head" / "texture", glm::dvec3(1.0)}}) {
        if (!std::filesystem::exists(data.path) || (!only.empty() && only != data.name)) continue;
        const auto volume = orEnd(cli::readInputVolume(data.path, data.spacingMm, 0));
        for (const char* kind : {"opaque", "translucent"})
            columns.push_back(measure(*context, std::string(data.name) + "-" + kind, volume.share(),
                                      chosen, {side, places, rounds, warm}));
    }
    printTable("by the clock", chosen, columns, &Column::singleMs, &Column::ms);
    printTable("by CPU time", chosen, columns, &Column::singleCpuMs, &Column::cpuMs);
    return 0;
}
