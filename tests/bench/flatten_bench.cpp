// Conformal maps of tubes: seconds, memory and distortion, beside conjugate gradients and CGAL's
// parameterizers of the tube cut open, as Markdown tables. `--help` tells the options.
#include "flatten/distortion.h"
#include "flatten/tube/conformal_tube.h"
#include "flatten/tube/flattening.h"
#include "flatten/tube/seam.h"
#include "flatten/tube/tube_topology.h"
#include "flatten_cgal.h"
#include "flatten_meshes.h"
#include "flatten_race.h"
#include "process_cost.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

using namespace haustra;
using bench::Cost;
using bench::Stopwatch;

namespace {

struct Settings {
    int threads = 0;
    bench::RaceOptions race;  ///< where it has rounds
    bool cgal = false;
    bool whole = false;             ///< flattenTube in place of its parts
    std::size_t arapTriangles = 0;  ///< as-rigid-as-possible up to this size
};

void printHeader(const char* first) {
    fmt::print(
        "\n| {} | wall s | CPU s | peak MiB | mean angle error ° | floor ° | 95 % ° | 99.9 % ° | "
        "max ° | mean dilatation | 99.9 % | max | ln area deviation | area range | flips |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
        "|\n",
        first);
}

void printRow(const std::string& name, const Cost& cost, const flatten::Distortion& d) {
    fmt::print(
        "| {} | {:.2f} | {:.2f} | {:.0f} | {:.3f} | {:.3f} | {:.2f} | {:.1f} | {:.1f} | {:.4f} | "
        "{:.3f} | {:.2f} | {:.3f} | {:.3g} | {} |\n",
        name, cost.wallS, cost.cpuS(), cost.peakMiB, d.angleErrorDegrees.mean, d.angleFloorDegrees,
        d.angleErrorDegrees.p95, d.angleErrorDegrees.p999, d.angleErrorDegrees.max,
        d.dilatation.mean, d.dilatation.p999, d.dilatation.max, d.logAreaDeviation, d.areaRange,
        d.flips);
    std::fflush(stdout);
}

flatten::Distortion distortionOf(const TriMesh& mesh, const flatten::PeriodicMap& map) {
    return flatten::measureDistortion(mesh,
                                      [&](std::size_t t, int c) { return map.corner(mesh, t, c); });
}

struct Run {
    flatten::ConformalTube tube;
    Cost cost;
    std::vector<Cost> phases;  ///< at their ends
};

Run runTube(const TriMesh& mesh, flatten::ConformalTubeOptions options) {
    Run run;
    const Stopwatch watch;
    options.progress = [&](double) { run.phases.push_back(watch.read()); };
    auto made = flatten::conformalTube(mesh, -1, options);
    run.cost = watch.read();
    if (!made) {
        fmt::print(stderr, "{}\n", describe(made.error()));
        std::exit(EXIT_FAILURE);
    }
    run.tube = std::move(*made);
    return run;
}

void printPhases(const Run& run) {
    static constexpr const char* names[] = {"topology", "Delaunay", "assembly and factor", "solve",
                                            "map and repair"};
    Cost before;
    for (std::size_t n = 0; n < run.phases.size() && n < std::size(names); ++n) {
        const Cost& now = run.phases[n];
        fmt::print("{}{} {:.3f} ({:.3f})", n == 0 ? "" : ", ", names[n], now.wallS - before.wallS,
                   now.cpuS() - before.cpuS());
        before = now;
    }
    fmt::print(" s of wall (CPU)\n");
}

/// The tube cut open along a shortest path from rim to rim.
struct Disc {
    TriMesh mesh;
    int corners[4];  ///< the path's ends, both copies, in order along the border
};

Disc cutOpen(const TriMesh& tube) {
    const auto edges = mesh::HalfedgeMesh::of(tube);
    const auto topology = flatten::tubeTopology(*edges, -1);
    Disc disc{tube, {}};
    std::vector<int> copyOf(tube.vertices.size(), -1);
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        for (int c = 0; c < 3; ++c) {
            if (topology->cornerTurns[3 * t + std::size_t(c)] == 0) continue;
            int& corner = disc.mesh.triangles[t][c];
            int& copy = copyOf[std::size_t(corner)];
            if (copy < 0) {
                copy = int(disc.mesh.vertices.size());
                disc.mesh.vertices.push_back(tube.vertices[std::size_t(corner)]);
            }
            corner = copy;
        }
    }
    for (int rim = 0; rim < 2; ++rim) {
        for (const int v : topology->rims[rim]) {
            if (copyOf[std::size_t(v)] < 0) continue;
            disc.corners[rim == 0 ? 0 : 3] = v;
            disc.corners[rim == 0 ? 1 : 2] = copyOf[std::size_t(v)];
        }
    }
    return disc;
}

void runCgal(const TriMesh& tube, double modulus, const Settings& settings) {
    const Disc disc = cutOpen(tube);
    const auto run = [&](bench::CgalMethod method, const char* name, double height) {
        const Stopwatch watch;
        const bench::DiscMap made = bench::cgalMap(disc.mesh, method, disc.corners);
        const Cost cost = watch.read();
        if (!made.failure.empty()) {
            fmt::print("| {} | {:.2f} | {:.2f} | {}\n", name, cost.wallS, cost.cpuS(),
                       made.failure);
            return;
        }
        const auto at = [&](std::size_t t, int c) {
            const auto v = std::size_t(disc.mesh.triangles[t][c]);
            return glm::dvec2(made.flat[v].x, height * made.flat[v].y);
        };
        // A map may come turned over as a whole.
        auto distortion = flatten::measureDistortion(disc.mesh, at);
        if (2 * distortion.flips > disc.mesh.triangles.size()) {
            distortion = flatten::measureDistortion(disc.mesh, [&](std::size_t t, int c) {
                const glm::dvec2 place = at(t, c);
                return glm::dvec2(-place.x, place.y);
            });
        }
        printRow(name, cost, distortion);
    };
    run(bench::CgalMethod::leastSquaresConformal, "CGAL LSCM, cut open", 1.0);
    run(bench::CgalMethod::discreteConformal, "CGAL discrete conformal to our rectangle", modulus);
    if (tube.triangles.size() <= settings.arapTriangles)
        run(bench::CgalMethod::asRigidAsPossible, "CGAL ARAP, cut open", 1.0);
}

/// What a tube costs that nothing is to be mended on: the map, the seam, the cut and the figures.
Cost plainCost(const TriMesh& mesh, const Settings& settings) {
    const Stopwatch watch;
    flatten::ConformalTubeOptions options;
    options.threads = settings.threads;
    options.repairFlips = false;
    if (const auto made = flatten::conformalTube(mesh, -1, options)) {
        const flatten::Distortion distortion = distortionOf(mesh, made->map);
        const FlatMap cut =
            flatten::cutAlongSeam(mesh, made->map, flatten::bestSeam(mesh, made->map));
        fmt::print("{} of {} triangles turned over in the plain map, {} after rounding\n",
                   distortion.flips, mesh.triangles.size(), flatten::foldedTriangles(cut).size());
    }
    return watch.read();
}

/// Map, pouches, seam and cut as a case gets them, beside the same of a tube that has no pouches.
void runWhole(const bench::Tube& tube, const Settings& settings) {
    flatten::ConformalTubeOptions warm;
    warm.threads = settings.threads;
    warm.repairFlips = false;
    fmt::print("\n{}: {} triangles, modulus {:.6f}\n", tube.name, tube.mesh.triangles.size(),
               runTube(tube.mesh, warm).tube.modulus);
    const Cost plain = plainCost(tube.mesh, settings);
    flatten::FlatteningOptions options;
    options.threads = settings.threads;
    const Stopwatch watch;
    const auto made = flatten::flattenTube(tube.mesh, -1, options);
    const Cost cost = watch.read();
    fmt::print("{:.2f} s ({:.2f} CPU), plain {:.2f} ({:.2f}): {:.1f} times\n", cost.wallS,
               cost.cpuS(), plain.wallS, plain.cpuS(), cost.cpuS() / plain.cpuS());
    if (!made) {
        fmt::print("refused: {}\n", describe(made.error()));
        return;
    }
    fmt::print("{} pouches, {:.0f} mm²; {} vertices repaired; {} folds on the lattice\n",
               made->pouches, made->pouchAreaMm2, made->repaired,
               flatten::foldedTriangles(made->map).size());
    printHeader("flattening");
    printRow("whole", cost, made->distortion);
    printRow("outside the pouches", cost, made->outside);
}

void runAll(const bench::Tube& tube, const Settings& settings) {
    if (settings.whole) return runWhole(tube, settings);
    flatten::ConformalTubeOptions options;
    options.threads = settings.threads;
    const Run direct = runTube(tube.mesh, options);
    const flatten::ConformalTube& made = direct.tube;
    fmt::print(
        "\n{}: {} triangles, modulus {:.6f}, certificate {:.2e}, {} negative weights, {} "
        "edges flipped, {} vertices repaired\n",
        tube.name, tube.mesh.triangles.size(), made.modulus, made.certificate, made.negativeWeights,
        made.flippedEdges, made.repaired);
    printPhases(direct);
    printHeader("map");
    printRow("Cholesky, Delaunay, repaired", direct.cost, distortionOf(tube.mesh, made.map));
    options.repairFlips = false;
    const Run bare = runTube(tube.mesh, options);
    printRow("not repaired", bare.cost, distortionOf(tube.mesh, bare.tube.map));
    options.intrinsicDelaunay = false;
    const Run plain = runTube(tube.mesh, options);
    printRow("the surface's own triangles", plain.cost, distortionOf(tube.mesh, plain.tube.map));
    if (settings.cgal) runCgal(tube.mesh, made.modulus, settings);
    if (settings.race.rounds > 0) bench::raceIterations(tube, settings.race);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Conformal maps of tubes: time, memory and distortion");
    std::vector<std::string> files, cases;
    std::string storeFolder;
    double voxelMm = 0.0;
    bench::SurfaceChoice choice;
    bool subdivide = false;
    Settings settings;
    app.add_option("meshes", files, "tubes, or closed surfaces that are punched");
    app.add_option("--generate-mm", voxelMm, "also a generated tube of this voxel size");
    double pouchedMm = 0.0;
    app.add_option("--pouched-mm", pouchedMm,
                   "also one with 150 diverticula and a blind ileum of 300 mm");
    app.add_option("--case", cases, "also the finest surface of a case")
        ->needs(app.add_option("--store", storeFolder, "the store's folder"));
    app.add_flag("--simplified", choice.product, "the cases' product `surface` in its place");
    app.add_option("--until", choice.until,
                   "the second hole is beside this share of a case's centerline, beyond which its "
                   "colon is one blind pouch");
    app.add_option("--error-mm", choice.errorMm, "simplify the cases' finest surfaces so far");
    app.add_flag("--subdivide", subdivide, "four triangles for each");
    app.add_option("--race", settings.race.rounds,
                   "also conjugate gradients, so many times each between our maps");
    app.add_option("--race-seconds", settings.race.seconds, "for each at most")
        ->capture_default_str();
    app.add_flag("--whole", settings.whole, "the whole flattening, as a case gets it");
    app.add_flag("--cgal", settings.cgal, "also CGAL's parameterizers");
    app.add_option("--arap-triangles", settings.arapTriangles,
                   "also CGAL's as-rigid-as-possible map up to so many triangles");
    app.add_option("--threads", settings.threads, "0: all cores")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    settings.race.threads = settings.threads;

    std::vector<std::function<Result<bench::Tube>()>> tubes;
    if (voxelMm > 0.0) tubes.push_back([&] { return bench::generatedTube(voxelMm); });
    if (pouchedMm > 0.0) tubes.push_back([&] { return bench::generatedTube(pouchedMm, true); });
    for (const std::string& file : files)
        tubes.push_back([&] { return bench::tubeOfFile(file); });
    for (const std::string& name : cases)
        tubes.push_back([&] { return bench::tubeOfCase(storeFolder, name, choice); });
    for (const auto& make : tubes) {
        const auto tube = make();
        if (!tube) {
            fmt::print(stderr, "{}\n", describe(tube.error()));
            return EXIT_FAILURE;
        }
        runAll(subdivide ? bench::subdivided(*tube) : *tube, settings);
    }
    return EXIT_SUCCESS;
}
