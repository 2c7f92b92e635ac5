// Conformal maps of tubes: seconds, memory and distortion, beside conjugate gradients and CGAL's
// parameterizers of the tube cut open, as Markdown tables. `--help` tells the options.
#include "flatten/conformal_tube.h"
#include "flatten/distortion.h"
#include "flatten/tube_topology.h"
#include "flatten_cgal.h"
#include "flatten_meshes.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/resource.h>

using namespace haustra;

namespace {

struct Settings {
    int threads = 0;
    double plainSeconds = 0.0, jacobiSeconds = 0.0;  ///< allowed to conjugate gradients
    bool cgal = false;
    std::size_t arapTriangles = 0;  ///< as-rigid-as-possible up to this size
};

/// Wall and CPU seconds (user and system, all threads) since it was made.
class Stopwatch {
public:
    struct Reading {
        double wall, cpu;
    };
    Reading read() const {
        const Reading now = clocks();
        return {now.wall - start_.wall, now.cpu - start_.cpu};
    }

private:
    static Reading clocks() {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        const auto seconds = [](const timeval& t) {
            return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
        };
        const auto wall = std::chrono::steady_clock::now().time_since_epoch();
        return {std::chrono::duration<double>(wall).count(),
                seconds(usage.ru_utime) + seconds(usage.ru_stime)};
    }
    Reading start_ = clocks();
};

/// Largest resident size of the process since resetPeak, MiB.
double peakMiB() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) return std::strtod(line.c_str() + 6, nullptr) / 1024.0;
    }
    return 0.0;
}
void resetPeak() {
    std::ofstream("/proc/self/clear_refs") << "5";
}

void printHeader(const char* first) {
    fmt::print(
        "\n| {} | wall s | CPU s | peak MiB | mean angle error ° | floor ° | 95 % ° | 99.9 % ° | "
        "max ° | mean dilatation | 99.9 % | max | ln area deviation | area range | flips |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
        "|\n",
        first);
}

void printRow(const std::string& name, const Stopwatch::Reading& time, double peak,
              const flatten::Distortion& d) {
    fmt::print(
        "| {} | {:.2f} | {:.2f} | {:.0f} | {:.3f} | {:.3f} | {:.2f} | {:.1f} | {:.1f} | {:.4f} | "
        "{:.3f} | {:.2f} | {:.3f} | {:.3g} | {} |\n",
        name, time.wall, time.cpu, peak, d.angleErrorDegrees.mean, d.angleFloorDegrees,
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
    Stopwatch::Reading time{};
    std::vector<std::pair<double, Stopwatch::Reading>> phases;  ///< progress at their ends
};

Run runTube(const TriMesh& mesh, flatten::ConformalTubeOptions options) {
    Run run;
    const Stopwatch watch;
    options.progress = [&](double fraction) { run.phases.emplace_back(fraction, watch.read()); };
    auto made = flatten::conformalTube(mesh, -1, options);
    run.time = watch.read();
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
    Stopwatch::Reading before{};
    for (std::size_t n = 0; n < run.phases.size() && n < std::size(names); ++n) {
        const Stopwatch::Reading& now = run.phases[n].second;
        fmt::print("{}{} {:.3f} ({:.3f})", n == 0 ? "" : ", ", names[n], now.wall - before.wall,
                   now.cpu - before.cpu);
        before = now;
    }
    fmt::print(" s of wall (CPU)\n");
}

/// Conjugate gradients on the surface's own triangles, as the dissertation has them, ended after
/// about `seconds` of wall time.
void runIterative(const TriMesh& mesh, const Run& direct, flatten::Solver solver, double seconds,
                  const std::string& name, const Settings& settings) {
    flatten::ConformalTubeOptions options;
    options.threads = settings.threads;
    options.solver = solver;
    options.intrinsicDelaunay = false;
    options.repairFlips = false;
    options.maxIterations = 40;
    const double few = runTube(mesh, options).time.wall;
    options.maxIterations = 240;
    const double more = runTube(mesh, options).time.wall;
    options.maxIterations = std::max(240, int(seconds / std::max(more - few, 1e-3) * 200.0));
    const Run run = runTube(mesh, options);
    printRow(fmt::format("{}, {} iterations{}", name, run.tube.iterations,
                         run.tube.converged ? "" : ", not converged"),
             run.time, 0.0, distortionOf(mesh, run.tube.map));
    fmt::print(stderr, "{}: {:.1f} times our wall time, {:.1f} times our CPU time{}\n", name,
               run.time.wall / direct.time.wall, run.time.cpu / direct.time.cpu,
               run.tube.converged ? "" : ", and not converged");
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
        resetPeak();
        const Stopwatch watch;
        const bench::DiscMap made = bench::cgalMap(disc.mesh, method, disc.corners);
        const Stopwatch::Reading time = watch.read();
        if (!made.failure.empty()) {
            fmt::print("| {} | {:.2f} | {:.2f} | {}\n", name, time.wall, time.cpu, made.failure);
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
        printRow(name, time, peakMiB(), distortion);
    };
    run(bench::CgalMethod::leastSquaresConformal, "CGAL LSCM, cut open", 1.0);
    run(bench::CgalMethod::discreteConformal, "CGAL discrete conformal to our rectangle", modulus);
    if (tube.triangles.size() <= settings.arapTriangles)
        run(bench::CgalMethod::asRigidAsPossible, "CGAL ARAP, cut open", 1.0);
}

void runAll(const bench::Tube& tube, const Settings& settings) {
    flatten::ConformalTubeOptions options;
    options.threads = settings.threads;
    resetPeak();
    const Run direct = runTube(tube.mesh, options);
    const double peak = peakMiB();
    const flatten::ConformalTube& made = direct.tube;
    fmt::print(
        "\n{}: {} triangles, modulus {:.6f}, certificate {:.2e}, {} negative weights, {} "
        "edges flipped, {} vertices repaired\n",
        tube.name, tube.mesh.triangles.size(), made.modulus, made.certificate, made.negativeWeights,
        made.flippedEdges, made.repaired);
    printPhases(direct);
    printHeader("map");
    printRow("Cholesky, Delaunay, repaired", direct.time, peak, distortionOf(tube.mesh, made.map));
    options.repairFlips = false;
    const Run bare = runTube(tube.mesh, options);
    printRow("not repaired", bare.time, 0.0, distortionOf(tube.mesh, bare.tube.map));
    options.intrinsicDelaunay = false;
    const Run plain = runTube(tube.mesh, options);
    printRow("the surface's own triangles", plain.time, 0.0,
             distortionOf(tube.mesh, plain.tube.map));
    if (settings.jacobiSeconds > 0.0) {
        runIterative(tube.mesh, direct, flatten::Solver::jacobiConjugateGradient,
                     settings.jacobiSeconds, "CG, Jacobi", settings);
    }
    if (settings.plainSeconds > 0.0) {
        runIterative(tube.mesh, direct, flatten::Solver::conjugateGradient, settings.plainSeconds,
                     "plain CG", settings);
    }
    if (settings.cgal) runCgal(tube.mesh, made.modulus, settings);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Conformal maps of tubes: time, memory and distortion");
    std::vector<std::string> files, cases;
    std::string storeFolder;
    double voxelMm = 0.0;
    bool simplified = false;
    Settings settings;
    app.add_option("meshes", files, "tubes, or closed surfaces that are punched");
    app.add_option("--generate-mm", voxelMm, "also a generated tube of this voxel size");
    app.add_option("--case", cases, "also the finest surface of a case")
        ->needs(app.add_option("--store", storeFolder, "the store's folder"));
    app.add_flag("--simplified", simplified, "the cases' product `surface` in place of the finest");
    app.add_option("--jacobi-seconds", settings.jacobiSeconds,
                   "also conjugate gradients with the diagonal, for so long at most");
    app.add_option("--plain-seconds", settings.plainSeconds, "also plain conjugate gradients");
    app.add_flag("--cgal", settings.cgal, "also CGAL's parameterizers");
    app.add_option("--arap-triangles", settings.arapTriangles,
                   "also CGAL's as-rigid-as-possible map up to so many triangles");
    app.add_option("--threads", settings.threads, "0: all cores")->capture_default_str();
    CLI11_PARSE(app, argc, argv);

    std::vector<std::function<Result<bench::Tube>()>> tubes;
    if (voxelMm > 0.0) tubes.push_back([&] { return bench::generatedTube(voxelMm); });
    for (const std::string& file : files)
        tubes.push_back([&] { return bench::tubeOfFile(file); });
    for (const std::string& name : cases)
        tubes.push_back([&] { return bench::tubeOfCase(storeFolder, name, simplified); });
    for (const auto& make : tubes) {
        const auto tube = make();
        if (!tube) {
            fmt::print(stderr, "{}\n", describe(tube.error()));
            return EXIT_FAILURE;
        }
        runAll(*tube, settings);
    }
    return EXIT_SUCCESS;
}
