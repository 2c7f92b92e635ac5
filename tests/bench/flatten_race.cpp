#include "flatten_race.h"

#include "cover_iteration.h"
#include "flatten/tube/conformal_tube.h"
#include "process_cost.h"
#include "stopwatch.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace haustra::bench {
namespace {

flatten::ConformalTube mapOf(const TriMesh& mesh, const flatten::ConformalTubeOptions& options) {
    auto made = flatten::conformalTube(mesh, -1, options);
    if (made) return std::move(*made);
    fmt::print(stderr, "{}\n", describe(made.error()));
    std::exit(EXIT_FAILURE);
}

struct Ours {
    Cost first, second;
};

Ours runOurs(const TriMesh& mesh, int threads) {
    return inFreshProcess<Ours>([&] {
        flatten::ConformalTubeOptions options;
        options.threads = threads;
        Ours costs;
        for (Cost* cost : {&costs.first, &costs.second}) {
            const Stopwatch watch;
            mapOf(mesh, options);
            *cost = watch.read();
        }
        return costs;
    });
}

struct Contender {
    const char* name;
    bool jacobi, onCover;
};

struct Iterated {
    Cost cost;
    int iterations = 0;
    bool converged = true;
    double certificate = 0.0;
};

Iterated iterate(const TriMesh& mesh, const Contender& which, int threads, int maxIterations) {
    Iterated run;
    if (which.onCover) {
        const CoverIteration made =
            iterateCover(mesh, {which.jacobi, 1e-10, maxIterations, threads});
        return {made.cost, made.iterations, made.converged, made.certificate};
    }
    flatten::ConformalTubeOptions options;
    options.threads = threads;
    options.solver = which.jacobi ? flatten::Solver::jacobiConjugateGradient
                                  : flatten::Solver::conjugateGradient;
    options.intrinsicDelaunay = false;
    options.repairFlips = false;
    options.maxIterations = maxIterations;
    const Stopwatch watch;
    const flatten::ConformalTube made = mapOf(mesh, options);
    return {watch.read(), made.iterations, made.converged, made.certificate};
}

/// In a fresh process, with as many iterations as fit the time.
Iterated runIterated(const TriMesh& mesh, const Contender& which, const RaceOptions& options) {
    return inFreshProcess<Iterated>([&] {
        const double few = iterate(mesh, which, options.threads, 40).cost.wallS,
                     more = iterate(mesh, which, options.threads, 240).cost.wallS;
        const int fit = int(options.seconds / std::max(more - few, 1e-3) * 200.0);
        return iterate(mesh, which, options.threads, std::max(240, fit));
    });
}

/// Ours before and after each of a contender's runs.
struct Lap {
    Ours before, after;
    Iterated run;
    /// Of a clock, to our first or second map.
    template <class Clock>
    double ratio(const Clock& clock, Cost Ours::*which) const {
        return 2.0 * clock(run.cost) / (clock(before.*which) + clock(after.*which));
    }
};

void printOurs(const char* name, const std::vector<Ours>& runs, Cost Ours::*which) {
    const auto middle = [&](const auto& clock) {
        std::vector<double> values;
        for (const Ours& run : runs)
            values.push_back(clock(run.*which));
        return median(values);
    };
    fmt::print("| {} | | {:.2f} | {:.2f} | {:.2f} | {:.0f} | | | | |\n", name,
               middle([](const Cost& c) { return c.wallS; }),
               middle([](const Cost& c) { return c.cpuS(); }),
               middle([](const Cost& c) { return c.systemS; }),
               middle([](const Cost& c) { return c.peakMiB; }));
}

void printLaps(const char* name, const std::vector<Lap>& laps) {
    const auto middle = [&](const auto& of) {
        std::vector<double> values;
        for (const Lap& lap : laps)
            values.push_back(of(lap));
        return median(values);
    };
    const auto wall = [](const Cost& c) { return c.wallS; };
    const auto cpu = [](const Cost& c) { return c.cpuS(); };
    const Iterated& last = laps.back().run;
    fmt::print("| {} | {}{} | {:.1f} | {:.1f} | {:.2f} | {:.0f} ", name, last.iterations,
               last.converged ? "" : ", not converged",
               middle([&](const Lap& lap) { return wall(lap.run.cost); }),
               middle([&](const Lap& lap) { return cpu(lap.run.cost); }),
               middle([](const Lap& lap) { return lap.run.cost.systemS; }), last.cost.peakMiB);
    for (Cost Ours::*which : {&Ours::first, &Ours::second}) {
        fmt::print("| {:.1f} | {:.1f} ",
                   middle([&](const Lap& lap) { return lap.ratio(wall, which); }),
                   middle([&](const Lap& lap) { return lap.ratio(cpu, which); }));
    }
    fmt::print("|\n");
}

}  // namespace

void raceIterations(const Tube& tube, const RaceOptions& options) {
    static constexpr Contender contenders[] = {
        {"Jacobi CG", true, false},
        {"plain CG", false, false},
        {"Jacobi CG, double cover", true, true},
        {"plain CG, double cover", false, true},
    };
    std::vector<Ours> ours{runOurs(tube.mesh, options.threads)};
    std::vector<Lap> laps[std::size(contenders)];
    for (int round = 0; round < options.rounds; ++round) {
        for (std::size_t n = 0; n < std::size(contenders); ++n) {
            const Iterated run = runIterated(tube.mesh, contenders[n], options);
            const Ours before = ours.back();
            ours.push_back(runOurs(tube.mesh, options.threads));
            laps[n].push_back({before, ours.back(), run});
        }
    }
    fmt::print("\n{}, {} triangles; medians of {} of ours and {} of each iteration\n\n", tube.name,
               tube.mesh.triangles.size(), ours.size(), options.rounds);
    fmt::print(
        "| solver | iterations | wall s | CPU s | of which system | peak MiB | to our first map, "
        "wall | CPU | to our second, wall | CPU |\n| --- | --- | --- | --- | --- | --- | --- | --- "
        "| --- | --- |\n");
    printOurs("ours, first map of a process", ours, &Ours::first);
    printOurs("ours, second map", ours, &Ours::second);
    for (std::size_t n = 0; n < std::size(contenders); ++n)
        printLaps(contenders[n].name, laps[n]);
    fmt::print("\ncertificates: {:.6e}", laps[0].back().run.certificate);
    for (std::size_t n = 1; n < std::size(contenders); ++n)
        fmt::print(", {:.6e}", laps[n].back().run.certificate);
    fmt::print("\n");
}

}  // namespace haustra::bench
