// Every raycaster that can be made on a case's endoscopic view, beside VTK's where it is there; one
// interleaved run. VTK needs a display: xvfb-run raycaster_table …
#include "core/centerline.h"
#include "pictures/picture_file.h"
#include "render/case_renderer.h"
#include "render/comparison.h"
#include "stopwatch.h"
#include "store/case_store.h"
#ifdef HAUSTRA_BENCH_VTK_VOLUME
#include "vtk_raycasters.h"
#endif

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace haustra;
using bench::cpuMilliseconds, bench::median, bench::milliseconds;

struct Arguments {
    std::string store, name, preset = "mucosa", pictures;
    std::vector<int> sizes{256, 512, 1024};
    int places = 15, threads = 0;
    bool vtk = true;
};

struct Contestant {
    std::string name;
    std::function<Result<Image>(const render::CameraView&, int size)> draw;
    std::vector<double> wallMs = {}, cpuMs = {}, psnr = {};
};

double psnr(const Image& a, const Image& b) {
    double squares = 0.0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i)
        squares += std::pow(double(a.rgb[i]) - double(b.rgb[i]), 2.0);
    return 10.0 * std::log10(255.0 * 255.0 / std::max(squares / double(a.rgb.size()), 1e-9));
}

std::vector<Contestant> contestants(render::CaseRenderer& renderer,
                                    [[maybe_unused]] const Volume<std::int16_t>& shown,
                                    [[maybe_unused]] const Arguments& given) {
    std::vector<Contestant> all;
    for (const RaycasterEntry& entry : raycasters()) {
        const RaycasterKind kind = entry.kind;
        if (const auto made = renderer.use(kind); !made) {
            fmt::print("{}: {}\n", toString(kind), describe(made.error()));
            continue;
        }
        all.push_back({toString(kind), [&renderer, kind](const auto& view, int size) {
                           return renderer.use(kind).and_then(
                               [&] { return renderer.render(view, size, size); });
                       }});
    }
#ifdef HAUSTRA_BENCH_VTK_VOLUME
    if (given.vtk) {
        for (const auto& [mapper, name] : {std::pair(bench::VtkMapper::fixedPoint, "VTK CPU"),
                                           {bench::VtkMapper::gpu, "VTK GPU"}}) {
            auto vtk = std::make_shared<bench::VtkRaycaster>(mapper, shown,
                                                             given.threads ? given.threads : 2);
            all.push_back({name, [vtk](const auto& view, int size) {
                               return Result<Image>(vtk->render(view, size, size));
                           }});
        }
    }
#endif
    return all;
}

Result<void> table(const Arguments& given) {
    const auto source = TRY(store::CaseStore::open(given.store, false).and_then([&](const auto& s) {
        return s.openCase(given.name);
    }));
    const auto ct = TRY(source.readVolume<std::int16_t>("ct"));
    const auto cleansed = TRY(source.readVolume<std::int16_t>("cleansed"));
    const auto path = TRY(source.readCenterline());
    auto surface = TRY(source.readMesh("surface"));
    const auto optics = TRY(render::opticsPreset(given.preset));
    auto prepared = TRY(render::prepareCase(ct, cleansed));
    prepared.wall = std::make_shared<const TriMesh>(std::move(surface));
    const Volume<std::int16_t> shown = prepared.endoscopic().share();

    const auto context = TRY(gpu::Context::create());
    const auto renderer = TRY(render::CaseRenderer::upload(
        *context, std::move(prepared),
        {.raycaster = RaycasterKind::native, .threads = given.threads}));
    fmt::print("{} ({}), {}, {} places\n", context->renderer(), context->platform(), given.preset,
               given.places);
    std::vector<Contestant> all = contestants(*renderer, shown, given);
    const auto ups = rotationMinimizingUps(path, flightPreferredUp);
    for (const int size : given.sizes) {
        for (Contestant& one : all)
            one.wallMs.clear(), one.cpuMs.clear(), one.psnr.clear();
        // The first round loads transfer functions and the driver's code: it is not counted.
        for (int place = -1; place < given.places; ++place) {
            const double arcMm = path.lengthMm() * (std::max(place, 0) + 0.5) / given.places;
            const CenterlineCamera at = cameraAtArc(path, ups, arcMm, FlightDirection::antegrade);
            render::CameraView view;
            view.camera.positionMm = at.positionMm;
            view.camera.forward = at.forward;
            view.camera.up = at.up;
            view.optics = optics;
            Image first;
            for (Contestant& one : all) {
                const double wall = milliseconds(), cpu = cpuMilliseconds();
                const auto image = TRY(one.draw(view, size));
                if (place < 0) continue;
                one.wallMs.push_back(milliseconds() - wall);
                one.cpuMs.push_back(cpuMilliseconds() - cpu);
                if (first.rgb.empty()) first = image;
                one.psnr.push_back(psnr(image, first));
                if (given.pictures.empty()) continue;
                const auto written =
                    pictures::writePicture(fmt::format("{}/{}-{}-{}-{}.png", given.pictures,
                                                       given.preset, size, place, one.name),
                                           image, {});
                if (!written) return written;
            }
        }
        fmt::print("\n{0} x {0}          wall ms   CPU ms   to native   PSNR to native, dB\n",
                   size);
        for (const Contestant& one : all)
            fmt::print("{:<16} {:9.1f} {:8.1f} {:11.2f} {:10.1f}\n", one.name, median(one.wallMs),
                       median(one.cpuMs), median(one.cpuMs) / median(all[0].cpuMs),
                       median(one.psnr));
    }
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    Arguments given;
    CLI::App app("Times raycasters on the endoscopic view of a prepared case.");
    app.add_option("store", given.store)->required();
    app.add_option("case", given.name)->required();
    app.add_option("--preset", given.preset);
    app.add_option("--sizes", given.sizes)->delimiter(',');
    app.add_option("--places", given.places)->check(CLI::Range(1, 1000));
    app.add_option("--threads", given.threads);
    app.add_option("--pictures", given.pictures, "an existing folder for every picture");
    app.add_flag("!--no-vtk", given.vtk, "leave VTK out");
    CLI11_PARSE(app, argc, argv);
    if (const auto done = table(given); !done) {
        fmt::print(stderr, "raycaster_table: {}\n", describe(done.error()));
        return 1;
    }
    return 0;
}
