// The object-order raycaster's figures: cell sides and skipping on a prepared case; a tall scan in
// a bounded pool along a flight; a volume larger than main memory.
#include "mapped_volume.h"
#include "pictures/picture_file.h"
#include "render/gl/single_pass_raycaster.h"
#include "render/object_order/object_order_raycaster.h"
#include "stopwatch.h"
#include "store/case_store.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

namespace {

using namespace haustra;
using namespace render;

using bench::cpuMilliseconds, bench::milliseconds, bench::quantile;

template <class T>
T orEnd(Result<T> made) {
    if (made) return std::move(*made);
    fmt::print(stderr, "object_order_table: {}\n", describe(made.error()));
    std::exit(1);
}

struct Drawn {
    Image image;
    double ms = 0.0, cpuMs = 0.0;
};

Drawn draw(Raycaster& raycaster, const CameraView& view, glm::ivec2 size) {
    Drawn drawn{{size.x, size.y, std::vector<std::uint8_t>(3u * unsigned(size.x * size.y))}};
    const double start = milliseconds(), cpu = cpuMilliseconds();
    const auto done = raycaster.render(view, Band::whole(size.x, size.y), drawn.image);
    drawn.ms = milliseconds() - start;
    drawn.cpuMs = cpuMilliseconds() - cpu;
    if (!done) {
        fmt::print(stderr, "object_order_table: {}\n", describe(done.error()));
        std::exit(1);
    }
    return drawn;
}

std::shared_ptr<const Scene> sceneOf(Volume<std::int16_t> volume, bool ranges) {
    Scene scene;
    if (ranges) scene.ranges = blockRanges(volume, blockSide, 0);
    scene.volume = std::move(volume);
    return std::make_shared<const Scene>(std::move(scene));
}

std::vector<CameraView> flight(const Centerline& path, int places, const Optics& optics) {
    const auto ups = rotationMinimizingUps(path, flightPreferredUp);
    std::vector<CameraView> views;
    for (int i = 0; i < places; ++i) {
        const CenterlineCamera at = cameraAtArc(path, ups, path.lengthMm() * (i + 0.5) / places,
                                                FlightDirection::antegrade);
        CameraView view;
        view.camera = {at.positionMm, at.forward, at.up, 90.0};
        view.optics = optics;
        views.push_back(view);
    }
    return views;
}

/// The whole volume from the front and somewhat above.
CameraView fromOutside(const Grid& grid, const Optics& optics) {
    const glm::dvec3 middle = grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size - 1));
    const double reach = glm::distance(middle, grid.patientFromVoxelPoint(glm::dvec3(0.0)));
    CameraView view;
    const glm::dvec3 along = glm::normalize(glm::dvec3(0.35, 0.85, -0.25));
    view.camera = {middle - 2.4 * reach * along, along, {0.0, 0.0, 1.0}, 45.0};
    view.optics = optics;
    view.optics.light.halfDepthMm = 1e6;  // a lamp at the camera would leave it dark
    return view;
}

void save(const std::string& folder, const std::string& name, const Image& image) {
    if (folder.empty()) return;
    if (const auto written = pictures::writePicture(folder + "/" + name + ".png", image, {});
        !written)
        fmt::print(stderr, "{}\n", describe(written.error()));
}

int apart(const Image& a, const Image& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i)
        count += std::abs(a.rgb[i] - b.rgb[i]) > 2;
    return count;
}

/// Cell sides, and what skipping empty cells gains, beside the single pass.
void cellSidesTable(gpu::Context& context, std::shared_ptr<const Scene> scene,
                    const Centerline& path, int side, int places, const std::string& folder) {
    auto single = orEnd(SinglePassRaycaster::create(orEnd(GlScene::upload(context, scene, 0))));
    fmt::print(
        "| view, optics | raycaster | CPU ms (median) | of single pass | cells not empty | "
        "in view | reached | values over 2/255 apart |\n|---|---|---|---|---|---|---|---|\n");
    for (const char* preset : {"mucosa", "translucent"}) {
        const Optics optics = orEnd(opticsPreset(preset));
        for (const bool inside : {true, false}) {
            std::vector<CameraView> views;
            if (inside) {
                views = flight(path, places, optics);
            } else {
                views.assign(3, fromOutside(scene->grid(), optics));
            }
            const std::string what = fmt::format("{}, {}", inside ? "colon" : "outside", preset);
            std::vector<Image> expected;
            std::vector<double> reference;
            draw(*single, views[0], glm::ivec2(side));
            for (const CameraView& view : views) {
                Drawn drawn = draw(*single, view, glm::ivec2(side));
                reference.push_back(drawn.cpuMs);
                expected.push_back(std::move(drawn.image));
            }
            save(folder, fmt::format("{}-{}-single", inside ? "colon" : "outside", preset),
                 expected[0]);
            fmt::print("| {} | single pass | {:.1f} | 1 | | | | |\n", what,
                       quantile(reference, 0.5));
            struct Choice {
                int cellSide, leafSide;
                bool leaping;
            };
            for (const auto& [cellSide, leafSide, leaping] :
                 {Choice{16, 0, true}, Choice{32, 0, true}, Choice{64, 0, true},
                  Choice{128, 0, true}, Choice{64, 4, true}, Choice{64, 8, true},
                  Choice{64, 64, true}, Choice{64, 0, false}}) {
                auto cells = orEnd(ObjectOrderRaycaster::create(
                    context, scene, {.cellSide = cellSide, .leafSide = leafSide}));
                std::vector<double> times;
                double inView = 0.0, visited = 0.0;
                int differ = 0;
                for (std::size_t i = 0; i < views.size(); ++i) {
                    CameraView view = views[i];
                    view.march.emptySpaceLeaping = leaping;
                    draw(*cells, view, glm::ivec2(side));  // brings the cells
                    const Drawn drawn = draw(*cells, view, glm::ivec2(side));
                    times.push_back(drawn.cpuMs);
                    inView += cells->residency().inView / double(views.size());
                    visited += cells->residency().visited / double(views.size());
                    differ = std::max(differ, apart(drawn.image, expected[i]));
                    if (i == 0 && cellSide == 64 && leafSide == 0 && leaping)
                        save(folder,
                             fmt::format("{}-{}-cells", inside ? "colon" : "outside", preset),
                             drawn.image);
                }
                const double ms = quantile(times, 0.5);
                fmt::print(
                    "| | cells of {}³{} | {:.1f} | {:.2f} | {} of {} | {:.0f} | {:.0f} | {} "
                    "|\n",
                    cellSide,
                    !leaping         ? ", nothing skipped"
                    : leafSide == 64 ? ", empty cells alone skipped"
                    : leafSide > 0   ? fmt::format(", leaves of {}³", leafSide)
                                     : "",
                    ms, ms / quantile(reference, 0.5), cells->residency().nonEmpty,
                    cells->residency().cells, inView, visited, differ);
            }
        }
    }
}

/// Flies through `scene` with a bounded pool, and holds each picture against what a pool that has
/// room for everything shows.
void flightTable(gpu::Context& context, std::shared_ptr<const Scene> scene,
                 const std::vector<CameraView>& views, int side, int cellSide, std::size_t budget,
                 bool compare) {
    auto bounded = orEnd(ObjectOrderRaycaster::create(
        context, scene, {.cellSide = cellSide, .budgetBytes = budget << 20}));
    std::unique_ptr<ObjectOrderRaycaster> roomy;
    if (compare)
        roomy = orEnd(ObjectOrderRaycaster::create(context, scene, {.cellSide = cellSide}));
    std::vector<double> times, cpuTimes, moved, waited, roomyTimes, roomyCpuTimes;
    int differ = 0, most = 0;
    draw(*bounded, views[0], glm::ivec2(64));  // compiles
    for (const CameraView& view : views) {
        const Drawn drawn = draw(*bounded, view, glm::ivec2(side));
        times.push_back(drawn.ms);
        cpuTimes.push_back(drawn.cpuMs);
        moved.push_back(double(bounded->residency().bytesMoved) / (1 << 20));
        waited.push_back(bounded->residency().waitedMs);
        most = std::max(most, bounded->residency().visited);
        if (!compare) continue;
        const Drawn whole = draw(*roomy, view, glm::ivec2(side));
        roomyTimes.push_back(whole.ms);
        roomyCpuTimes.push_back(whole.cpuMs);
        differ += whole.image.rgb != drawn.image.rgb;
    }
    const ResidencyStats& stats = bounded->residency();
    fmt::print(
        "cells of {}³, budget {} MiB: {} of {} cells not empty, {} slots, at most {} in a "
        "picture\n",
        cellSide, budget, stats.nonEmpty, stats.cells, stats.resident, most);
    fmt::print(
        "  ms a frame: median {:.1f} (fps {:.1f}), p95 {:.1f}, worst {:.1f} = {:.2f} medians; "
        "second half: worst {:.1f}\n",
        quantile(times, 0.5), 1e3 / quantile(times, 0.5), quantile(times, 0.95),
        quantile(times, 1.0), quantile(times, 1.0) / quantile(times, 0.5),
        quantile({times.begin() + std::ptrdiff_t(times.size() / 2), times.end()}, 1.0));
    fmt::print(
        "  MiB moved a frame: median {:.2f}, p95 {:.2f}, worst {:.1f}; ms waited: median "
        "{:.2f}, worst {:.1f}\n",
        quantile(moved, 0.5), quantile(moved, 0.95), quantile(moved, 1.0), quantile(waited, 0.5),
        quantile(waited, 1.0));
    const auto cpu = [](const char* what, const std::vector<double>& ms) {
        fmt::print(
            "  {} CPU ms a frame: median {:.1f}, p95 {:.1f}, worst {:.1f} = {:.2f} medians\n", what,
            quantile(ms, 0.5), quantile(ms, 0.95), quantile(ms, 1.0),
            quantile(ms, 1.0) / quantile(ms, 0.5));
    };
    cpu("bounded:", cpuTimes);
    if (!compare) return;
    cpu("all resident:", roomyCpuTimes);
    fmt::print(
        "  all resident ({} slots): median {:.1f} ms, worst {:.2f} medians; pictures that "
        "differ: {} of {}\n",
        roomy->residency().resident, quantile(roomyTimes, 0.5),
        quantile(roomyTimes, 1.0) / quantile(roomyTimes, 0.5), differ, views.size());
}

/// The case's volume over and over along z, every second time upside down so that it fits.
Volume<std::int16_t> stacked(const Volume<std::int16_t>& one, int slices) {
    Grid grid = one.grid();
    const int period = grid.size.z;
    grid.size.z = slices;
    Volume<std::int16_t> volume(grid);
    const std::size_t slice = std::size_t(grid.size.x) * std::size_t(grid.size.y);
    for (int z = 0; z < slices; ++z) {
        const int at = z % period, from = z / period % 2 ? period - 1 - at : at;
        std::copy_n(&one.voxels()[slice * std::size_t(from)], slice,
                    &volume.writable()[slice * std::size_t(z)]);
    }
    return volume;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Figures of the object-order raycaster.");
    std::string store, name, folder, huge;
    int side = 512, places = 25, frames = 200, cellSide = 64;
    std::size_t budget = 256;
    bool sides = false, tall = false;
    app.add_option("store", store)->required();
    app.add_option("case", name)->required();
    app.add_flag("--sides", sides, "cell sides and skipping, on the case");
    app.add_flag("--tall", tall, "a scan of 1887 slices made from the case, in a bounded pool");
    app.add_option("--huge", huge,
                   "a sparse volume of 2048x2048x4096 in this file (removed after)");
    app.add_option("--size", side, "pixels along a picture's side");
    app.add_option("--places", places, "places along the colon (--sides)");
    app.add_option("--frames", frames, "frames of a flight");
    app.add_option("--cell", cellSide, "voxels along a cell's side (--tall, --huge)");
    app.add_option("--budget", budget, "MiB of cells on the GPU (--tall, --huge)");
    app.add_option("--pictures", folder, "folder for pictures");
    CLI11_PARSE(app, argc, argv);

    const auto source = orEnd(orEnd(store::CaseStore::open(store, false)).openCase(name));
    const auto ct = orEnd(source.readVolume<std::int16_t>("ct"));
    const auto cleansed = source.readVolume<std::int16_t>("cleansed");
    const auto path = orEnd(source.readCenterline());
    const Volume<std::int16_t>& scan = cleansed ? *cleansed : ct;
    const auto context = orEnd(gpu::Context::create());
    fmt::print("{}\n", context->renderer());
    const Optics optics = orEnd(opticsPreset("mucosa"));
    if (sides) cellSidesTable(*context, sceneOf(scan.share(), true), path, side, places, folder);
    if (tall) {
        // The copies along z hold the same colon: a flight through the first, then one through the
        // third.
        const Volume<std::int16_t> volume = stacked(scan, 1887);
        std::vector<CameraView> views = flight(path, frames / 2, optics);
        const double period = 2.0 * scan.grid().size.z;
        const glm::dvec3 shift(volume.grid().patientFromVoxel * glm::dvec4(0.0, 0.0, period, 0.0));
        for (CameraView view : flight(path, frames - frames / 2, optics)) {
            view.camera.positionMm += shift;
            views.push_back(view);
        }
        const auto scene = sceneOf(volume.share(), false);
        fmt::print("{}x{}x{}, flight of {} frames at {}²\n", volume.grid().size.x,
                   volume.grid().size.y, volume.grid().size.z, views.size(), side);
        flightTable(*context, scene, views, side, cellSide, budget, true);
        std::vector<CameraView> around;
        for (int i = 0; i < 12; ++i) {
            CameraView view = fromOutside(volume.grid(), orEnd(opticsPreset("translucent")));
            around.push_back(view);
        }
        fmt::print("the same from outside, translucent\n");
        flightTable(*context, scene, around, side, cellSide, budget, true);
        auto outside =
            orEnd(ObjectOrderRaycaster::create(*context, scene, {.budgetBytes = budget << 20}));
        save(folder, "tall-outside", draw(*outside, around[0], {512, 1024}).image);
        save(folder, "tall-inside",
             draw(*outside, views[std::size_t(frames) / 4], {512, 512}).image);
    }
    if (!huge.empty()) {
        const glm::ivec3 size(2048, 2048, 4096), corner(768, 768, 1900);
        const auto volume = orEnd(bench::sparseVolume(huge, scan, size, corner));
        std::vector<CameraView> views = flight(path, frames, optics);
        const glm::dvec3 shift = volume.grid().patientFromVoxelPoint(glm::dvec3(corner)) -
                                 scan.grid().patientFromVoxelPoint(glm::dvec3(0.0));
        for (CameraView& view : views)
            view.camera.positionMm += shift;
        const double start = milliseconds();
        const auto scene = sceneOf(volume.share(), false);
        auto made = orEnd(ObjectOrderRaycaster::create(
            *context, scene, {.cellSide = cellSide, .budgetBytes = budget << 20}));
        fmt::print("{} GiB; octree in {:.0f} s\n", volume.sizeBytes() >> 30,
                   1e-3 * (milliseconds() - start));
        made.reset();
        flightTable(*context, scene, views, side, cellSide, budget, false);
    }
    return 0;
}
