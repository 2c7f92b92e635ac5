// Every raycaster against the native one, at the same sampling: how far pictures of cases and of
// general volumes are apart, inside and outside, opaque and translucent.
#include "cli/input_volume.h"
#include "core/centerline.h"
#include "render/case_renderer.h"
#include "store/case_store.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

namespace {

using namespace haustra;
using namespace render;

template <class T>
T orEnd(Result<T> made) {
    if (made) return std::move(*made);
    fmt::print(stderr, "agreement_table: {}\n", describe(made.error()));
    std::exit(1);
}

struct Difference {
    double psnrDb;
    double shareOver2;  ///< of the pixels, in any channel
    int most;
};

Difference difference(const Image& a, const Image& b) {
    double squares = 0.0;
    std::size_t over = 0;
    int most = 0;
    for (std::size_t pixel = 0; pixel < a.rgb.size(); pixel += 3) {
        int here = 0;
        for (std::size_t c = pixel; c < pixel + 3; ++c) {
            const int apart = std::abs(int(a.rgb[c]) - int(b.rgb[c]));
            squares += double(apart) * apart;
            here = std::max(here, apart);
        }
        over += here > 2;
        most = std::max(most, here);
    }
    const double mean = std::max(squares / double(a.rgb.size()), 1e-9);
    return {10.0 * std::log10(255.0 * 255.0 / mean), 3.0 * double(over) / double(a.rgb.size()),
            most};
}

constexpr RaycasterKind compared[] = {RaycasterKind::singlePass, RaycasterKind::polygonAssisted,
                                      RaycasterKind::objectOrder, RaycasterKind::hybrid};

struct Worst {
    int views = 0;
    double psnrDb = INFINITY, shareOver2 = 0.0;
};

/// Prints a line a view and raycaster that the scene allows, and keeps the worst of each.
void compare(CaseRenderer& renderer, const std::string& what, const std::vector<CameraView>& views,
             int side, std::vector<Worst>& worst) {
    for (std::size_t i = 0; i < views.size(); ++i) {
        orEnd(renderer.use(RaycasterKind::native).map([] { return true; }));
        const Image native = orEnd(renderer.render(views[i], side, side));
        fmt::print("{:24s} {}", what, i + 1);
        for (std::size_t k = 0; k < std::size(compared); ++k) {
            if (!renderer.use(compared[k])) continue;
            const Difference apart =
                difference(native, orEnd(renderer.render(views[i], side, side)));
            fmt::print("   {} {:.1f} dB, {:.4f} %, {}", toString(compared[k]), apart.psnrDb,
                       100.0 * apart.shareOver2, apart.most);
            ++worst[k].views;
            worst[k].psnrDb = std::min(worst[k].psnrDb, apart.psnrDb);
            worst[k].shareOver2 = std::max(worst[k].shareOver2, apart.shareOver2);
        }
        fmt::print("\n");
    }
}

void compareCase(gpu::Context& context, const store::Case& source, int side,
                 std::vector<Worst>& worst) {
    auto prepared = orEnd(prepareCase(orEnd(source.readVolume<std::int16_t>("ct")),
                                      orEnd(source.readVolume<std::int16_t>("cleansed"))));
    prepared.wall = std::make_shared<const TriMesh>(orEnd(source.readMesh()));
    const Centerline path = orEnd(source.readCenterline());
    const auto renderer = orEnd(
        CaseRenderer::upload(context, std::move(prepared), {.raycaster = RaycasterKind::native}));
    const auto ups = rotationMinimizingUps(path, flightPreferredUp);
    for (const char* preset : {"mucosa", "translucent"}) {
        std::vector<CameraView> views;
        for (const double share : {0.15, 0.45, 0.8}) {
            const CenterlineCamera at =
                cameraAtArc(path, ups, share * path.lengthMm(), FlightDirection::antegrade);
            CameraView view;
            view.camera = {at.positionMm, at.forward, at.up, 90.0};
            view.optics = orEnd(opticsPreset(preset));
            views.push_back(std::move(view));
        }
        compare(*renderer, source.name() + " " + preset, views, side, worst);
    }
}

void compareVolume(gpu::Context& context, const std::string& name, Volume<std::int16_t> volume,
                   int side, std::vector<Worst>& worst) {
    const Grid grid = volume.grid();
    const auto renderer =
        orEnd(CaseRenderer::create(context, volume, {}, {.raycaster = RaycasterKind::native}));
    const glm::dvec3 middle = grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size - 1));
    const double reach = glm::distance(middle, grid.patientFromVoxelPoint(glm::dvec3(0.0)));
    for (const char* kind : {"-opaque", "-translucent"}) {
        std::vector<CameraView> views;
        for (const double turn : {0.6, 2.7, 4.8}) {
            const glm::dvec3 along =
                glm::normalize(glm::dvec3(std::cos(turn), std::sin(turn), -0.3));
            CameraView view;
            view.camera = {middle - 2.2 * reach * along, along, {0.0, 0.0, 1.0}, 45.0};
            view.optics = orEnd(opticsPreset(name + kind));
            views.push_back(std::move(view));
        }
        compare(*renderer, name + kind, views, side, worst);
    }
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App program("Holds every raycaster's pictures against the native one's.");
    std::string storeFolder, volumes;
    std::vector<std::string> cases;
    int side = 512;
    program.add_option("--store", storeFolder, "A store with prepared cases");
    program.add_option("--case", cases, "Their names");
    program.add_option("--volumes", volumes, "Folder of engine, bonsai and head");
    program.add_option("--size", side, "Pixels")->check(CLI::Range(1, maxPictureSide));
    CLI11_PARSE(program, argc, argv);
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    const auto context = orEnd(gpu::Context::create());
    std::vector<Worst> worst(std::size(compared));
    for (const std::string& name : cases)
        compareCase(*context,
                    orEnd(store::CaseStore::open(storeFolder, false).and_then([&](const auto& s) {
                        return s.openCase(name);
                    })),
                    side, worst);
    if (!volumes.empty()) {
        const std::filesystem::path folder = volumes;
        const auto read = [](const std::filesystem::path& path, glm::dvec3 spacingMm) {
            return orEnd(cli::readInputVolume(path, spacingMm, 0));
        };
        compareVolume(*context, "engine", read(folder / "engine.nii.gz", glm::dvec3(1.0)), side,
                      worst);
        compareVolume(*context, "bonsai", read(folder / "bonsai.nii.gz", glm::dvec3(1.0)), side,
                      worst);
        compareVolume(*context, "head",
                      read(folder / "visible_human_ct_head" / "texture", glm::dvec3(1.0)), side,
                      worst);
    }
    for (std::size_t k = 0; k < worst.size(); ++k)
        fmt::print("worst {}: of {} views {:.1f} dB, {:.4f} % of pixels over 2/255\n",
                   toString(compared[k]), worst[k].views, worst[k].psnrDb,
                   100.0 * worst[k].shareOver2);
    return 0;
}
