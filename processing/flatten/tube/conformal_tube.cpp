#include "flatten/tube/conformal_tube.h"

#include "flatten/cotangent_laplacian.h"
#include "flatten/intrinsic_delaunay.h"
#include "flatten/tube/conjugate_gradient.h"
#include "flatten/tube/flip_repair.h"
#include "flatten/tube/tube_solver.h"
#include "flatten/tube/tube_topology.h"

#include <cmath>
#include <utility>

namespace haustra::flatten {
namespace {

/// The strip's x from v, whose triangles are whole with `cornerTurns` added; `sign` is that of the
/// direction in which x grows.
PeriodicMap periodicMap(const TriMesh& tube, const std::vector<std::int8_t>& cornerTurns,
                        const std::vector<double>& u, const std::vector<double>& v, double height,
                        double sign) {
    PeriodicMap map;
    map.height = height;
    map.flat.resize(tube.vertices.size());
    for (std::size_t n = 0; n < map.flat.size(); ++n)
        map.flat[n] = {sign * v[n], u[n] * height};
    map.turns.resize(tube.triangles.size());
    for (std::size_t t = 0; t < map.turns.size(); ++t) {
        for (std::size_t c = 0; c < 3; ++c)
            map.turns[t][c] = std::int8_t(sign * cornerTurns[3 * t + c]);
    }
    rotate(map, tube, 0.0);
    return map;
}

/// Twice the flat area of the triangles, for one unit of u and v each.
double signedArea(const TriMesh& tube, const std::vector<std::int8_t>& cornerTurns,
                  const std::vector<double>& u, const std::vector<double>& v) {
    double area = 0.0;
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        glm::dvec2 at[3];
        for (int c = 0; c < 3; ++c) {
            const auto vertex = std::size_t(tube.triangles[t][c]);
            at[c] = {v[vertex] + cornerTurns[3 * t + std::size_t(c)], u[vertex]};
        }
        const glm::dvec2 a = at[1] - at[0], b = at[2] - at[0];
        area += a.x * b.y - a.y * b.x;
    }
    return area;
}

}  // namespace

Result<ConformalTube> conformalTube(const TriMesh& tube, int firstLoop,
                                    const ConformalTubeOptions& options) {
    const auto report = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    ConformalTube made;
    TubeTopology topology;
    IntrinsicMesh mesh;
    {
        const auto halfedges = TRY(mesh::HalfedgeMesh::of(tube));
        auto found = TRY(tubeTopology(halfedges, firstLoop));
        topology = std::move(found);
        mesh = intrinsicMesh(halfedges, topology.cornerTurns);
    }
    report(0.1);
    made.negativeWeights = countNegative(mesh);
    if (options.intrinsicDelaunay) made.flippedEdges = makeDelaunay(mesh);
    report(0.2);

    TubeSolution solution;
    if (options.solver == Solver::cholesky) {
        auto found = TRY(
            solveTube(mesh, topology, tube.vertices.size(), options.threads, [&] { report(0.8); }));
        solution = std::move(found);
    } else {
        auto found = iterateTube(mesh, topology, tube.vertices.size(),
                                 {options.solver == Solver::jacobiConjugateGradient,
                                  options.tolerance, options.maxIterations, options.threads});
        solution = std::move(found.values);
        made.iterations = found.iterations;
        made.converged = found.converged;
    }
    const std::vector<double>&u = solution.u, &v = solution.v;
    report(0.9);

    double energyU = 0.0, energyV = 0.0;
    parallelFor(2, 1, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            (n == 0 ? energyU : energyV) = dirichletEnergy(mesh, n == 0 ? u : v, n == 1);
    });
    made.certificate = energyU * energyV - 1.0;
    made.modulus = std::sqrt(energyV / energyU);
    if (!std::isfinite(made.modulus) || !(made.modulus > 0.0)) {
        return fail(ErrorKind::noResult,
                    "the surface cannot be flattened: its coordinates leave its equations without "
                    "a finite solution");
    }
    const double sign = signedArea(tube, topology.cornerTurns, u, v) < 0.0 ? -1.0 : 1.0;
    made.map = periodicMap(tube, topology.cornerTurns, u, v, made.modulus, sign);
    if (options.repairFlips) made.repaired = repairMap(made.map, tube);
    report(1.0);
    return made;
}

}  // namespace haustra::flatten
