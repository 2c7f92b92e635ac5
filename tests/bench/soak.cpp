// Thousands of small pictures of a case with random cameras, views and optics, by every raycaster:
// for the sanitizers and the driver's own checks to look on. Ends with 1 where something went
// wrong.
#include "gpu/context.h"
#include "render/case_renderer.h"
#include "render/optics/optics_presets.h"
#include "session/open_case.h"
#include "session/picture_job.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

namespace haustra {
namespace {

std::size_t residentMib() {
    std::size_t total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return resident * std::size_t(::sysconf(_SC_PAGESIZE)) >> 20;
}

class RandomViews {
public:
    RandomViews(const session::OpenCase& facts, unsigned seed) : facts_(facts), random_(seed) {}

    double within(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    int below(int count) { return int(random_() % unsigned(count)); }

    session::AnyView next() {
        switch (below(10)) {
            case 0:
                return SliceView{View(int(View::axial) + below(3)),
                                 place(),
                                 within(1.0, 8.0),
                                 {within(-500, 500), within(1, 3000)},
                                 facts_.cleansed && below(2) ? Scan::cleansed : Scan::original};
            case 1:
                return ObliqueView{place(), direction(), direction(), within(5, 300), {}};
            case 2: {
                render::OverviewView view;
                view.camera = camera();
                if (view.camera.lens == Lens::fisheye)
                    view.camera = {place(), direction(), direction()};
                if (below(2)) view.reader = camera();
                for (int n = below(4); n > 0; --n)
                    view.bookmarksMm.push_back(place());
                view.path = below(2);
                view.body = below(2);
                view.optics = optics();
                return view;
            }
            case 3:
                if (!facts_.wall) return cameraView();
                return render::FlatView{
                    {{within(0, 1), within(0, facts_.wall->map->height)}, within(40, 2000)},
                    optics(),
                    march()};
            case 4:
                if (!facts_.wall || below(4)) return cameraView();
                return render::FlatOverview{optics(), march()};
            default:
                return cameraView();
        }
    }

private:
    glm::dvec3 place() {
        if (!facts_.centerline.points.empty() && below(4))
            return facts_.centerline
                .points[std::size_t(below(int(facts_.centerline.points.size())))]
                .positionMm;
        const glm::dvec3 voxel(within(-1, 2), within(-1, 2), within(-1, 2));
        return facts_.grid.patientFromVoxelPoint(voxel * glm::dvec3(facts_.grid.size));
    }
    glm::dvec3 direction() { return {within(-1, 1), within(-1, 1), within(-1, 1)}; }
    Camera camera() {
        Camera made{place(), direction(), direction(), within(5, 160)};
        made.lens = Lens(below(3));
        if (made.lens == Lens::fisheye) made.fovDegrees = within(30, 360);
        made.heightMm = within(5, 500);
        return made;
    }
    render::MarchOptions march() { return {below(4) ? 0.5 : within(0.2, 1.0), below(8) != 0}; }
    std::vector<render::TransferFunctionPoint> points() {
        std::vector<double> hu(std::size_t(2 + below(6)));
        for (double& value : hu)
            value = within(-1100, 1500);
        std::sort(hu.begin(), hu.end());
        std::vector<render::TransferFunctionPoint> made;
        for (const double value : hu)
            made.push_back(
                {value, {within(0, 1), within(0, 1), within(0, 1)}, below(3) ? within(0, 1) : 0.0});
        return made;
    }
    render::Optics optics() {
        const auto& presets = render::builtInPresets();
        if (below(2)) return presets[std::size_t(below(int(presets.size())))].optics;
        render::Optics made;
        made.transferFunction.points = points();
        if (!below(3))
            for (double steep = within(1, 50); steep < 800 && !below(2); steep *= 3)
                made.transferFunction.rows.push_back({steep, points()});
        made.composition = render::Composition(below(4) ? 0 : below(3));
        made.preIntegrated = made.transferFunction.rows.empty() && below(3) == 0;
        made.shading = below(4) != 0;
        return made;
    }
    session::AnyView cameraView() { return render::CameraView{camera(), optics(), march()}; }

    const session::OpenCase& facts_;
    std::mt19937 random_;
};

Result<Image> draw(render::CaseRenderer& renderer, const session::AnyView& view, int side,
                   int bandRows) {
    const auto* camera = std::get_if<render::CameraView>(&view);
    if (!camera)
        return std::visit([&](const auto& any) { return renderer.render(any, side, side); }, view);
    Image picture{side, side, std::vector<std::uint8_t>(3 * std::size_t(side) * std::size_t(side))};
    for (int row = 0; row < side; row += bandRows) {
        const render::Band band{{side, side}, row, std::min(bandRows, side - row)};
        if (auto drawn = renderer.render(*camera, band, picture); !drawn)
            return tl::make_unexpected(drawn.error());
    }
    return picture;
}

const char* nameOf(const session::AnyView& view) {
    constexpr std::array names{"camera", "slice", "oblique", "overview", "strip window", "strip"};
    static_assert(names.size() == std::variant_size_v<session::AnyView>);
    return names[view.index()];
}

struct Kept {
    RaycasterKind kind;
    session::AnyView view;
    int bandRows;
    Image picture;
};

int soak(int argc, char** argv) {
    std::string storeFolder, caseName;
    int frames = 10'000, side = 96, lifetimes = 4, seed = 1;
    double budgetMb = 8.0;
    CLI::App program("Random pictures by every raycaster; prints memory over time.");
    program.add_option("store", storeFolder)->required();
    program.add_option("case", caseName)->required();
    program.add_option("--frames", frames)->capture_default_str();
    program.add_option("--side", side)->capture_default_str();
    program.add_option("--lifetimes", lifetimes, "Renderers one after the other")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    program.add_option("--gpu-budget", budgetMb, "Of the object-order raycaster")
        ->capture_default_str();
    program.add_option("--seed", seed)->capture_default_str();
    CLI11_PARSE(program, argc, argv);

    const auto broken = [](const Error& error) {
        fmt::print(stderr, "soak: {}\n", describe(error));
        return 1;
    };
    const auto store = store::CaseStore::open(storeFolder, false);
    if (!store) return broken(store.error());
    const auto source = store->openCase(caseName);
    if (!source) return broken(source.error());
    auto files = session::readCase(*source);
    if (!files) return broken(files.error());
    auto context = gpu::Context::create();
    if (!context) return broken(context.error());
    if (files->flattened) {
        auto wall = session::readWall(*source);
        if (!wall) return broken(wall.error());
        files->facts.wall = *wall;
    }
    std::shared_ptr<const TriMesh> surface;
    if (files->surface) {
        auto read = session::readSurface(*source);
        if (!read) return broken(read.error());
        surface = *read;
    }
    fmt::print("{}, {} frames of {}x{}\n", (*context)->renderer(), frames, side, side);

    RandomViews views(files->facts, unsigned(seed));
    std::map<std::string, int> drawn, refused;
    std::vector<std::size_t> memory;
    int different = 0;
    for (int lifetime = 0, frame = 0; lifetime < lifetimes; ++lifetime) {
        auto prepared = render::prepareCase(files->ct, files->cleansed);
        if (!prepared) return broken(prepared.error());
        if (files->facts.wall) prepared->flatMap = files->facts.wall->map;
        prepared->wall = surface;
        prepared->path = std::make_shared<const Centerline>(files->facts.centerline);
        render::RendererOptions options;
        options.gpuBudgetBytes = std::size_t(budgetMb * double(1 << 20));
        auto renderer = render::CaseRenderer::upload(**context, std::move(*prepared), options);
        if (!renderer) return broken(renderer.error());
        std::vector<RaycasterKind> kinds;
        for (const RaycasterEntry& entry : raycasters()) {
            const auto used = (*renderer)->use(entry.kind);
            if (used)
                kinds.push_back(entry.kind);
            else if (lifetime == 0)
                fmt::print("no {} raycaster: {}\n", entry.name, describe(used.error()));
        }
        if (kinds.empty()) return broken({ErrorKind::device, "no raycaster can be made", ""});
        std::vector<Kept> kept;
        const int until = int(std::int64_t(frames) * (lifetime + 1) / lifetimes);
        for (; frame < until; ++frame) {
            const RaycasterKind kind = kinds[std::size_t(frame) % kinds.size()];
            if (auto used = (*renderer)->use(kind); !used) return broken(used.error());
            const session::AnyView view = views.next();
            const int bandRows = 1 + views.below(side);
            auto picture = draw(**renderer, view, side, bandRows);
            ++(picture ? drawn : refused)[toString(kind)];
            if (!picture && picture.error().kind != ErrorKind::badInput) {
                fmt::print(stderr, "frame {}, {}, {} raycaster\n", frame, nameOf(view),
                           toString(kind));
                return broken(picture.error());
            }
            if (picture && kept.size() < 20)
                kept.push_back({kind, view, bandRows, std::move(*picture)});
            if ((frame + 1) % std::max(1, frames / 20) == 0) {
                memory.push_back(residentMib());
                fmt::print("{:6} frames: resident {} MiB, GPU {:.1f} MiB, GL errors {}\n",
                           frame + 1, memory.back(),
                           double((*renderer)->gpuBytes()) / double(1 << 20),
                           (*context)->errorCount());
                std::fflush(stdout);
            }
        }
        // Equal views give equal pixels, whatever was drawn before.
        for (const Kept& one : kept) {
            if (auto used = (*renderer)->use(one.kind); !used) return broken(used.error());
            for (const int rows : {one.bandRows, side}) {
                const auto again = draw(**renderer, one.view, side, rows);
                if (again && again->rgb == one.picture.rgb) continue;
                ++different;
                fmt::print("{}, {} raycaster, in bands of {} rows: not what {} rows were\n",
                           nameOf(one.view), toString(one.kind), rows, one.bandRows);
            }
        }
    }
    for (const auto& [kind, count] : drawn)
        fmt::print("{}: {} drawn, {} refused as bad input\n", kind, count, refused[kind]);
    const int errors = (*context)->errorCount();
    const std::size_t early = memory.size() > 5 ? memory[memory.size() / 4] : 0;
    const bool grows = early > 0 && double(memory.back()) > 1.15 * double(early);
    fmt::print("GL errors {}, different pictures {}, memory {}\n", errors, different,
               grows ? "grows" : "steady");
    return errors == 0 && different == 0 && !grows ? 0 : 1;
}

}  // namespace
}  // namespace haustra

int main(int argc, char** argv) {
    try {
        return haustra::soak(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "soak: %s\n", error.what());
        return 1;
    }
}
