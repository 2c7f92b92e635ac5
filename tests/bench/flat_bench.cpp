// Times the flattened views of a prepared case, and counts the triangles that the strip shows.
// usage: flat_bench STORE CASE [PRESET [RAYCASTER]]
#include "render/gl/flat_painter.h"
#include "render/strip_picture.h"
#include "stopwatch.h"
#include "store/case_store.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace haustra;

using bench::cpuMilliseconds, bench::milliseconds;

/// Pictures drawn whole, and in bands of some 8 ms, in turns.
struct Timed {
    std::vector<double> wholeMs = {};
    double cpuMs = 0.0, cpuMsInBands = 0.0, longestBandMs = 0.0;
    int bands = 0;

    template <class View>
    Result<void> time(render::CaseRenderer& renderer, const View& view, int side) {
        const double start = milliseconds(), cpuStart = cpuMilliseconds();
        const auto whole = TRY(renderer.render(view, side, side));
        const double cpuEnd = cpuMilliseconds();
        wholeMs.push_back(milliseconds() - start);
        cpuMs += cpuEnd - cpuStart;
        // As the server's scheduler cuts them.
        const int rows = std::max(1, int(8.0 / wholeMs.back() * side / 16)) * 16;
        Image picture = blankImage({side, side});
        for (int row = 0; row < side; ++bands) {
            const int left = side - row, here = left < rows + rows / 2 ? left : rows;
            const double bandStart = milliseconds();
            if (auto drawn = renderer.render(view, {{side, side}, row, here}, picture); !drawn)
                return drawn;
            longestBandMs = std::max(longestBandMs, milliseconds() - bandStart);
            row += here;
        }
        cpuMsInBands += cpuMilliseconds() - cpuEnd;
        if (picture.rgb != whole.rgb)
            return fail(ErrorKind::device, "bands show another picture than the whole");
        return {};
    }
    void print() {
        std::sort(wholeMs.begin(), wholeMs.end());
        const double pictures = double(wholeMs.size());
        std::printf(
            "median %.1f ms, worst %.1f ms; processor time %.1f ms; in %.1f bands %.1f ms, "
            "the longest %.1f ms elapsed\n",
            wholeMs[wholeMs.size() / 2], wholeMs.back(), cpuMs / pictures, bands / pictures,
            cpuMsInBands / pictures, longestBandMs);
    }
};

/// A hand that drags the window along and around the strip, at one enlargement after the other;
/// then the whole strip.
Result<void> timeWindows(render::CaseRenderer& renderer, const FlatMap& map,
                         const render::Optics& function) {
    constexpr int side = 512, pictures = 60;
    for (const double pixels : {400.0, 1000.0, 2500.0, 6000.0}) {
        Timed timed;
        for (int i = -1; i < pictures; ++i) {
            const double along = (std::max(i, 0) + 0.5) / pictures;
            const render::FlatView view{{{7.0 * along, map.height * along}, pixels}, function, {}};
            if (auto drawn = timed.time(renderer, view, side); !drawn) return drawn;
            // The first picture loads the transfer function and the driver's code.
            if (i < 0) timed = {};
        }
        std::printf("window %d x %d, %4.0f pixels a circumference: ", side, side, pixels);
        timed.print();
    }
    for (const int overviewSide : {512, 1024}) {
        Timed timed;
        for (int i = 0; i < 5; ++i)
            if (auto drawn = timed.time(renderer, render::FlatOverview{function, {}}, overviewSide);
                !drawn)
                return drawn;
        std::printf("the whole strip in %d x %d: ", overviewSide, overviewSide);
        timed.print();
    }
    return {};
}

Result<void> timeStrips(render::CaseRenderer& renderer, const FlatMap& map,
                        const render::Optics& function) {
    for (const int width : {400, 1600}) {
        const render::StripPicture picture{width, 0.0, function, {}};
        const double start = milliseconds(), processor = cpuMilliseconds();
        int rows = 0;
        const auto drawn = render::drawStrip(renderer, picture, map.height, [&](const Image& band) {
            rows += band.height;
            return Result<void>();
        });
        if (!drawn) return drawn;
        std::printf("strip %d x %d: %.2f s; processor time %.2f s\n", width, rows,
                    (milliseconds() - start) / 1000.0, (cpuMilliseconds() - processor) / 1000.0);
    }
    return {};
}

double turn(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

/// Of each triangle, in the flat plane: area and the radius of its inscribed circle.
struct FlatTriangle {
    glm::dvec2 center{0.0};
    double area = 0.0, inradius = 0.0;
};

FlatTriangle flatTriangle(const FlatMap& map, std::size_t triangle) {
    const glm::ivec3 t = map.surface.triangles[triangle];
    const glm::dvec2 a = map.flat[std::size_t(t.x)], b = map.flat[std::size_t(t.y)],
                     c = map.flat[std::size_t(t.z)];
    const double ab = glm::distance(a, b), bc = glm::distance(b, c), ca = glm::distance(c, a);
    FlatTriangle flat;
    flat.center = (bc * a + ca * b + ab * c) / (ab + bc + ca);
    flat.area = 0.5 * turn(b - a, c - a);
    flat.inradius = 2.0 * flat.area / (ab + bc + ca);
    return flat;
}

/// Triangles of positive area that tile the rectangle appear once each; and which of them own a
/// pixel of the strip, or of a closer look where they are too small for that.
Result<void> countTriangles(const FlatMap& map, const Grid& grid) {
    const std::size_t count = map.surface.triangles.size();
    double area = 0.0;
    std::size_t flipped = 0;
    for (std::size_t t = 0; t < count; ++t) {
        const double one = flatTriangle(map, t).area;
        area += one;
        flipped += one <= 0.0;
    }
    std::printf("%zu triangles, %zu not of positive area; areas sum to the strip's to %.1e\n",
                count, flipped, std::abs(area / map.height - 1.0));
    auto painter = TRY(render::FlatPainter::create(map, grid));
    std::vector<bool> seen(count, false);
    const auto look = [&](const FlatWindow& window, glm::ivec2 size) -> Result<void> {
        if (auto found = painter.findTriangles(window, render::Band::whole(size.x, size.y)); !found)
            return found;
        for (const int triangle : painter.triangleOfPixel())
            if (triangle >= 0) seen[std::size_t(triangle)] = true;
        return {};
    };
    for (const int width : {400, 1600}) {
        constexpr int rows = 1024;
        for (int row = 0; row < map.height * width; row += rows) {
            const FlatWindow window{{0.5, (row + 0.5 * rows) / width}, double(width)};
            if (auto looked = look(window, {width, rows}); !looked) return looked;
        }
        std::printf("strip %d wide: %zu triangles own a pixel\n", width,
                    std::size_t(std::count(seen.begin(), seen.end(), true)));
    }
    for (std::size_t t = 0; t < count; ++t) {
        const FlatTriangle flat = flatTriangle(map, t);
        if (seen[t] || !(flat.inradius > 0.0)) continue;
        const FlatWindow window{
            flat.center, std::clamp(2.0 / flat.inradius, 1.0, double(render::maxPixelsPerUnit))};
        if (auto looked = look(window, {9, 9}); !looked) return looked;
    }
    std::printf("with closer looks at the rest: %zu\n",
                std::size_t(std::count(seen.begin(), seen.end(), true)));
    return {};
}

Result<void> timeCase(const std::string& store, const std::string& name, const std::string& preset,
                      const std::string& raycaster) {
    const auto kind = TRY(raycasterFromString(raycaster));
    const auto source = TRY(store::CaseStore::open(store, false).and_then([&](const auto& s) {
        return s.openCase(name);
    }));
    const auto ct = TRY(source.readVolume<std::int16_t>("ct"));
    const auto cleansed = TRY(source.readVolume<std::int16_t>("cleansed"));
    auto map = TRY(source.readFlatMap());
    const auto shared = std::make_shared<const FlatMap>(std::move(map));
    const auto function = TRY(render::opticsPreset(preset));
    auto prepared = TRY(render::prepareCase(ct, cleansed));
    prepared.flatMap = shared;

    const auto context = TRY(gpu::Context::create());
    const auto renderer =
        TRY(render::CaseRenderer::upload(*context, std::move(prepared), {.raycaster = kind}));
    std::printf("%s (%s); strip of %.2f circumferences; %zu MiB on the GPU\n",
                context->renderer().c_str(), context->platform().c_str(), shared->height,
                renderer->gpuBytes() >> 20);
    return timeWindows(*renderer, *shared, function)
        .and_then([&] { return timeStrips(*renderer, *shared, function); })
        .and_then([&] { return countTriangles(*shared, ct.grid()); });
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3 || argc > 5) {
        std::fprintf(stderr, "usage: flat_bench STORE CASE [PRESET [RAYCASTER]]\n");
        return 2;
    }
    if (const auto done = timeCase(argv[1], argv[2], argc > 3 ? argv[3] : "mucosa",
                                   argc > 4 ? argv[4] : "single-pass");
        !done) {
        std::fprintf(stderr, "flat_bench: %s\n", haustra::describe(done.error()).c_str());
        return 1;
    }
    return 0;
}
