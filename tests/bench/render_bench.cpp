// Times the endoscopic picture of a prepared case along its centerline, bare and with its wall
// painted. usage: render_bench STORE CASE [PRESET]
#include "core/centerline.h"
#include "render/case_renderer.h"
#include "stopwatch.h"
#include "store/case_store.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace haustra;
using bench::milliseconds;

constexpr int places = 25;

Result<void> timePictures(const std::string& store, const std::string& name,
                          const std::string& preset) {
    const auto source = TRY(store::CaseStore::open(store, false).and_then([&](const auto& s) {
        return s.openCase(name);
    }));
    const auto ct = TRY(source.readVolume<std::int16_t>("ct"));
    const auto cleansed = TRY(source.readVolume<std::int16_t>("cleansed"));
    const auto centerline = TRY(source.readCenterline());
    const auto function = TRY(render::opticsPreset(preset));

    const auto context = TRY(gpu::Context::create());
    const double before = milliseconds();
    auto prepared = TRY(render::prepareCase(ct, cleansed));
    auto map = TRY(source.readFlatMap());
    // A sixteenth of the wall, in spots of half a circumference and less.
    auto paint = std::make_shared<render::WallPaint>();
    paint->size = {1024, 8192}, paint->height = map.height, paint->smooth = true;
    paint->pixels.resize(std::size_t(paint->size.x) * std::size_t(paint->size.y));
    for (std::size_t n = 0; n < paint->pixels.size(); ++n)
        if (n % 1024 < 256 && n / 1024 % 256 < 64) paint->pixels[n] = {0, 230, 110, 165};
    prepared.flatMap = std::make_shared<const FlatMap>(std::move(map));
    const auto renderer = TRY(render::CaseRenderer::upload(*context, std::move(prepared)));
    std::printf("%s (%s); case on the GPU in %.0f ms, %zu MiB\n", context->renderer().c_str(),
                context->platform().c_str(), milliseconds() - before, renderer->gpuBytes() >> 20);

    const auto ups = rotationMinimizingUps(centerline, flightPreferredUp);
    for (const bool painted : {false, true})
        for (const int size : {256, 512, 1024}) {
            std::vector<double> times;
            // The first picture loads the transfer function and the driver's code: it is not
            // counted.
            for (int i = -1; i < places; ++i) {
                const double arcMm = centerline.lengthMm() * (std::max(i, 0) + 0.5) / places;
                const CenterlineCamera at =
                    cameraAtArc(centerline, ups, arcMm, FlightDirection::antegrade);
                render::CameraView view;
                view.camera = {at.positionMm, at.forward, at.up, 90.0};
                view.optics = function;
                if (painted) view.paint = paint;
                const double start = milliseconds();
                TRY(renderer->render(view, size, size));
                if (i >= 0) times.push_back(milliseconds() - start);
            }
            std::sort(times.begin(), times.end());
            std::printf("%s %4d x %-4d  median %6.1f ms   p95 %6.1f ms   worst %6.1f ms\n",
                        painted ? "painted" : "bare   ", size, size, times[places / 2],
                        times[places * 95 / 100], times.back());
        }
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3 || argc > 4) {
        std::fprintf(stderr, "usage: render_bench STORE CASE [PRESET]\n");
        return 2;
    }
    if (const auto done = timePictures(argv[1], argv[2], argc > 3 ? argv[3] : "mucosa"); !done) {
        std::fprintf(stderr, "render_bench: %s\n", haustra::describe(done.error()).c_str());
        return 1;
    }
    return 0;
}
