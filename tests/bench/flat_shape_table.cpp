// What the flat map does to shapes and sizes, as Markdown tables: for cases in a store, angles
// against areas at several area weights and by a change of height alone; for their true polyps, the
// aspect ratio of the outline in the plane beside that on the surface, and how even the scale is
// that they are shown at; and how far from where they began pixels come back from the surface.
// `--help` tells the options.
#include "core/flat_lookup.h"
#include "flat_outline.h"
#include "flatten/distortion.h"
#include "flatten/tube/conformal_tube.h"
#include "flatten/tube/seam.h"
#include "flatten/tube/unified_flattening.h"
#include "flatten_meshes.h"
#include "phantom_polyps.h"
#include "stopwatch.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

using namespace haustra;

using bench::milliseconds;

namespace {

struct Polyp {
    std::string of;  ///< the case
    bench::PhantomPolyp truth;
    const std::string& kind() const { return truth.finding.kind; }
};

struct Compared {
    const Polyp* polyp;
    bench::OutlineShape onSurface, inPlane;
    double stretch;  ///< from one to the other
    double areaMm2;  ///< of the surface inside
    double off() const { return inPlane.aspect / onSurface.aspect - 1.0; }
};

/// A case's tube, its conformal map and what else the tables tell of it.
struct Study {
    bench::Tube tube;
    mesh::HalfedgeMesh edges;
    flatten::PeriodicMap conformal;
    std::vector<Polyp> polyps;
};

[[noreturn]] void stop(const Error& error) {
    fmt::print(stderr, "{}\n", describe(error));
    std::exit(1);
}

template <class T>
T need(Result<T> result) {
    if (!result) stop(result.error());
    return std::move(*result);
}

std::vector<Polyp> polypsOf(const std::string& file, const std::string& of) {
    std::vector<Polyp> polyps;
    for (auto& polyp : need(bench::polypsOfPhantom(file)))
        polyps.push_back({of, std::move(polyp)});
    return polyps;
}

flatten::Distortion distortionOf(const TriMesh& tube, const flatten::PeriodicMap& map) {
    return flatten::measureDistortion(
        tube, [&](std::size_t triangle, int corner) { return map.corner(tube, triangle, corner); });
}

/// The map with y made to grow, by `share` of the way, as the surface below it does.
flatten::PeriodicMap evenedByHeight(const TriMesh& tube, flatten::PeriodicMap map, double share) {
    constexpr int rings = 4000;
    std::vector<double> below(rings + 1, 0.0);
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        const double y =
            (map.corner(tube, t, 0).y + map.corner(tube, t, 1).y + map.corner(tube, t, 2).y) / 3.0;
        const glm::ivec3 v = tube.triangles[t];
        const glm::dvec3 a = tube.vertices[std::size_t(v.x)];
        below[1 + std::size_t(std::clamp(rings * y / map.height, 0.0, rings - 1.0))] += glm::length(
            glm::cross(tube.vertices[std::size_t(v.y)] - a, tube.vertices[std::size_t(v.z)] - a));
    }
    for (std::size_t r = 1; r < below.size(); ++r)
        below[r] += below[r - 1];
    for (glm::dvec2& place : map.flat) {
        const double at = std::clamp(rings * place.y / map.height, 0.0, double(rings));
        const auto ring = std::size_t(std::min(at, rings - 1.0));
        const double even = glm::mix(below[ring], below[ring + 1], at - double(ring));
        place.y = glm::mix(place.y, map.height * even / below[rings], share);
    }
    return map;
}

void printDistortion(const std::string& name, const std::string& how, const TriMesh& tube,
                     const flatten::PeriodicMap& map, double seconds) {
    const flatten::Distortion d = distortionOf(tube, map);
    fmt::print("| {} | {} | {:.2f} | {:.1f} | {:.3f} | {:.3f} | {:.3g} | {} | {:.2f} | {} |\n",
               name, how, d.angleErrorDegrees.mean, d.angleErrorDegrees.p95, d.dilatation.mean,
               d.logAreaDeviation, d.areaRange, d.flips, map.height,
               seconds < 0.0 ? "-" : fmt::format("{:.1f}", seconds));
    std::fflush(stdout);
}

/// The map with an area weight; its seconds.
flatten::PeriodicMap unified(const Study& study, double weight, int threads, double& seconds) {
    flatten::UnifiedOptions options;
    options.areaWeight = weight;
    options.threads = threads;
    const double start = milliseconds();
    auto map = need(flatten::unifiedFlattening(study.tube.mesh, study.conformal, options));
    seconds = 1e-3 * (milliseconds() - start);
    return map;
}

std::vector<Compared> compare(const Study& study, const flatten::PeriodicMap& map) {
    std::vector<Compared> all;
    for (const Polyp& polyp : study.polyps) {
        // A loop in a plane of space, or one draped over the wall.
        const bool girth = polyp.kind() == "pedunculated";
        const auto outline = bench::outlineOf(study.tube.mesh, study.edges, map,
                                              girth ? polyp.truth.girth : polyp.truth.border);
        if (!outline) {
            fmt::print(stderr, "{}: no outline of the {:.1f} mm {} polyp\n", polyp.of,
                       polyp.truth.finding.diameterMm, polyp.kind());
            continue;
        }
        const auto own = girth ? bench::fromAbove(outline->placesMm) : outline->unrolledMm;
        all.push_back({&polyp, bench::shapeOf(own), bench::shapeOf(outline->flat),
                       bench::stretchBetween(own, outline->flat), outline->insideMm2});
    }
    return all;
}

void printPolyps(const std::string& weight, const std::vector<Compared>& all) {
    for (const Compared& c : all) {
        fmt::print(
            "| {} | {} | {} | {:.1f} | {:.1f} | {:.2f} | {:.2f} | {:+.0f} | {:.2f} | {:.1f} |\n",
            weight, c.polyp->of, c.polyp->kind(), c.polyp->truth.finding.diameterMm,
            std::sqrt(4.0 / M_PI * c.onSurface.area), c.onSurface.aspect, c.inPlane.aspect,
            100.0 * c.off(), c.stretch, 1000.0 * std::sqrt(4.0 / M_PI * c.inPlane.area));
    }
}

/// How many polyps keep their aspect within a tenth, and the spread of the scale they are shown at:
/// of the square root of flat area over area.
void printSummary(const std::string& weight, const std::string& kind,
                  const std::vector<Compared>& all) {
    int count = 0, kept = 0, alike = 0;
    double sum = 0.0, squares = 0.0, worst = 0.0;
    for (const Compared& c : all) {
        if (kind != "all" && c.polyp->kind() != kind) continue;
        ++count;
        kept += std::abs(c.off()) <= 0.1;
        alike += c.stretch <= 1.1;
        worst = std::max(worst, std::abs(c.off()));
        const double zoom = 0.5 * std::log(c.inPlane.area / c.areaMm2);
        sum += zoom, squares += zoom * zoom;
    }
    if (count == 0) return;
    const double deviation = std::sqrt(std::max(0.0, squares / count - sum * sum / count / count));
    fmt::print("| {} | {} | {} | {} ({:.0f} %) | {:.0f} | {} | {:.0f} |\n", weight, kind, count,
               kept, 100.0 * kept / count, 100.0 * worst, alike,
               100.0 * (std::exp(deviation) - 1.0));
}

/// 10,000 random pixels of a strip 1600 wide, to the surface and back.
void printRoundTrip(const Study& study) {
    constexpr int pixels = 10000;
    constexpr double pixelsPerUnit = 1600.0;
    const TriMesh& tube = study.tube.mesh;
    FlatMap cut =
        flatten::cutAlongSeam(tube, study.conformal, flatten::bestSeam(tube, study.conformal));
    cut.cameras.push_back({});
    cut.camera.assign(cut.flat.size(), 0);
    const auto since = [](double start) { return 1e-3 * (milliseconds() - start); };
    const double begin = milliseconds();
    const FlatLookup lookup(std::make_shared<const FlatMap>(std::move(cut)));
    const double buildSeconds = since(begin);

    std::mt19937 random(1);
    std::vector<WallPlace> places;
    const auto rows = unsigned(pixelsPerUnit * lookup.map().height);
    double start = milliseconds();
    for (int n = 0; n < pixels; ++n) {
        const glm::dvec2 pixel(random() % unsigned(pixelsPerUnit) + 0.5, random() % rows + 0.5);
        places.push_back(*lookup.at(pixel / pixelsPerUnit));
    }
    const double atSeconds = since(start);
    double worst = 0.0;
    int beyondHalf = 0;
    start = milliseconds();
    for (const WallPlace& place : places) {
        const WallPlace back = lookup.nearest(place.positionMm);
        const double off =
            pixelsPerUnit * std::max(std::abs(std::remainder(back.flat.x - place.flat.x, 1.0)),
                                     std::abs(back.flat.y - place.flat.y));
        worst = std::max(worst, off);
        beyondHalf += off > 0.5;
    }
    fmt::print("| {} | {:.2g} | {} | {:.2f} | {:.1f} | {:.1f} |\n", study.tube.name, worst,
               beyondHalf, buildSeconds, 1e6 * atSeconds / pixels, 1e6 * since(start) / pixels);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Shapes and sizes on the flat maps of cases in a store.");
    std::string storeFolder;
    std::vector<std::string> cases, truths;
    std::vector<double> weights{0.1, 0.3, 0.5, 0.8, 1.0};
    int threads = 0;
    app.add_option("--store", storeFolder, "The case store's folder")->required();
    app.add_option("--case", cases, "Cases' names")->required();
    app.add_option("--phantom", truths, "phantom.json of each case's phantom, in order");
    app.add_option("--weights", weights, "Area weights beside 0")->capture_default_str();
    app.add_option("--threads", threads, "Threads; 0 for all cores");
    CLI11_PARSE(app, argc, argv);
    if (!truths.empty() && truths.size() != cases.size())
        stop({ErrorKind::badInput, "must be as many as the cases", "--phantom"});

    std::vector<Study> studies;
    for (std::size_t n = 0; n < cases.size(); ++n) {
        auto tube = need(bench::tubeOfCase(storeFolder, cases[n], {.product = true}));
        auto edges = need(mesh::HalfedgeMesh::of(tube.mesh));
        auto made = need(flatten::conformalTube(tube.mesh));
        studies.push_back({std::move(tube), std::move(edges), std::move(made.map),
                           truths.empty() ? std::vector<Polyp>{} : polypsOf(truths[n], cases[n])});
    }

    fmt::print(
        "| case | map | angle error ° | 95 % | dilatation | log-area deviation | area range "
        "| flips | height | seconds |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- "
        "| --- |\n");
    std::vector<std::vector<Compared>> byWeight(weights.size() + 1);
    for (const Study& study : studies) {
        const TriMesh& tube = study.tube.mesh;
        const auto add = [&](std::size_t n, const flatten::PeriodicMap& map) {
            const auto found = compare(study, map);
            byWeight[n].insert(byWeight[n].end(), found.begin(), found.end());
        };
        printDistortion(study.tube.name, "conformal", tube, study.conformal, -1.0);
        add(0, study.conformal);
        for (const double share : {0.5, 1.0})
            printDistortion(study.tube.name, fmt::format("height alone, {}", share), tube,
                            evenedByHeight(tube, study.conformal, share), -1.0);
        for (std::size_t n = 0; n < weights.size(); ++n) {
            double seconds = 0.0;
            const auto map = unified(study, weights[n], threads, seconds);
            printDistortion(study.tube.name, fmt::format("weight {}", weights[n]), tube, map,
                            seconds);
            add(n + 1, map);
        }
    }
    fmt::print(
        "\n| case | there and back, worst pixels | over half a pixel | seconds to build | µs "
        "to the surface | back |\n| --- | --- | --- | --- | --- | --- |\n");
    for (const Study& study : studies)
        printRoundTrip(study);
    if (truths.empty()) return 0;
    const auto name = [&](std::size_t n) {
        return fmt::format("{}", n == 0 ? 0.0 : weights[n - 1]);
    };
    fmt::print(
        "\n| area weight | case | polyp | mm | outline mm | aspect on the surface | in the plane "
        "| off % | stretch | shown at ‰ of the circumference |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (std::size_t n = 0; n < byWeight.size(); ++n)
        printPolyps(name(n), byWeight[n]);
    fmt::print(
        "\n| area weight | polyps | count | aspect within 10 % | worst % | stretch within 1.1 "
        "| spread of scale % |\n| --- | --- | --- | --- | --- | --- | --- |\n");
    for (std::size_t n = 0; n < byWeight.size(); ++n) {
        for (const char* kind : {"all", "sessile", "flat", "pedunculated"})
            printSummary(name(n), kind, byWeight[n]);
    }
}
