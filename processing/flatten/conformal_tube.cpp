#include "flatten/conformal_tube.h"

#include "flatten/conjugate_gradient.h"
#include "flatten/cotangent_laplacian.h"
#include "flatten/flip_repair.h"
#include "flatten/intrinsic_delaunay.h"
#include "flatten/shape_relaxation.h"
#include "flatten/sparse_cholesky.h"
#include "flatten/tube_topology.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::flatten {
namespace {

/// The unknowns' order: the vertices inside, then those on the rims; the last of these is held at 0
/// in v, and all of them are held in u.
struct Numbering {
    std::vector<int> unknownOf;  ///< per vertex; −1: none
    std::vector<int> vertexOf;   ///< per unknown
    int inside = 0;
};

Numbering numberUnknowns(const TubeTopology& topology, std::size_t vertices) {
    Numbering made;
    made.unknownOf.assign(vertices, 0);
    for (const auto& rim : topology.rims) {
        for (const int v : rim)
            made.unknownOf[std::size_t(v)] = 1;
    }
    std::vector<int> rimVertices;
    for (const int v : topology.breadthFirst)
        (made.unknownOf[std::size_t(v)] != 0 ? rimVertices : made.vertexOf).push_back(v);
    made.inside = int(made.vertexOf.size());
    made.vertexOf.insert(made.vertexOf.end(), rimVertices.begin(), rimVertices.end() - 1);
    made.unknownOf.assign(vertices, -1);
    for (std::size_t n = 0; n < made.vertexOf.size(); ++n)
        made.unknownOf[std::size_t(made.vertexOf[n])] = int(n);
    return made;
}

struct Systems {
    SymmetricMatrix matrix;
    std::vector<double> pullU;  ///< of the unknowns inside
    std::vector<double> pullV;
};

struct Solution {
    std::vector<double> u, v;  ///< per unknown
    int iterations = 0;
    bool converged = true;
};

Result<Solution> solve(const Systems& systems, const ConformalTubeOptions& options) {
    Solution found;
    if (options.solver == Solver::cholesky) {
        auto cholesky = SparseCholesky::of(systems.matrix, int(systems.pullU.size()));
        if (!cholesky) return tl::make_unexpected(cholesky.error());
        if (options.progress) options.progress(0.8);
        found.u = cholesky->solveLeading(systems.pullU);
        found.v = cholesky->solve(systems.pullV);
        return found;
    }
    IterativeSolution sides[2];
    parallelFor(2, 1, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            sides[n] = conjugateGradient(systems.matrix, n == 0 ? systems.pullU : systems.pullV,
                                         options.solver == Solver::jacobiConjugateGradient,
                                         options.tolerance, options.maxIterations);
        }
    });
    found.u = std::move(sides[0].x);
    found.v = std::move(sides[1].x);
    found.iterations = sides[0].iterations + sides[1].iterations;
    found.converged = sides[0].converged && sides[1].converged;
    return found;
}

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

/// Unfolds flips, and straightens what is left of them and other slivers. Returns the number of
/// vertices moved.
int repair(PeriodicMap& map, const TriMesh& tube) {
    constexpr double kMostDilatation = 4.0;
    constexpr int kSweeps = 20;
    const VertexStars stars(tube);
    std::vector<int> moved = unfold(map, tube, stars);
    const std::vector<int> stretched = stretchedVertices(map, tube, stars, kMostDilatation);
    relaxShapes(map, tube, stars, stretched, kSweeps);
    moved.insert(moved.end(), stretched.begin(), stretched.end());
    std::sort(moved.begin(), moved.end());
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    rotate(map, tube, 0.0);
    return int(moved.size());
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
        const auto halfedges = mesh::HalfedgeMesh::of(tube);
        if (!halfedges) return tl::make_unexpected(halfedges.error());
        auto found = tubeTopology(*halfedges, firstLoop);
        if (!found) return tl::make_unexpected(found.error());
        topology = std::move(*found);
        mesh = intrinsicMesh(*halfedges, topology.cornerTurns);
    }
    report(0.1);
    made.negativeWeights = countNegative(mesh);
    if (options.intrinsicDelaunay) made.flippedEdges = makeDelaunay(mesh);
    report(0.2);

    const Numbering numbering = numberUnknowns(topology, tube.vertices.size());
    std::vector<double> u(tube.vertices.size(), 0.0), v(tube.vertices.size(), 0.0);
    for (const int rim : topology.rims[1])
        u[std::size_t(rim)] = 1.0;
    const int unknowns = int(numbering.vertexOf.size());
    Systems systems;
    systems.matrix = cotangentLaplacian(mesh, numbering.unknownOf, unknowns);
    systems.pullU = pullOfFixed(mesh, numbering.unknownOf, unknowns, u);
    systems.pullU.resize(std::size_t(numbering.inside));
    systems.pullV = pullOfTurns(mesh, numbering.unknownOf, unknowns);
    report(0.3);

    const auto solution = solve(systems, options);
    if (!solution) return tl::make_unexpected(solution.error());
    made.iterations = solution->iterations;
    made.converged = solution->converged;
    for (std::size_t n = 0; n < solution->u.size(); ++n)
        u[std::size_t(numbering.vertexOf[n])] = solution->u[n];
    for (std::size_t n = 0; n < solution->v.size(); ++n)
        v[std::size_t(numbering.vertexOf[n])] = solution->v[n];
    report(0.9);

    const double energyU = dirichletEnergy(mesh, u, false),
                 energyV = dirichletEnergy(mesh, v, true);
    made.certificate = energyU * energyV - 1.0;
    made.modulus = std::sqrt(energyV / energyU);
    if (!std::isfinite(made.modulus) || !(made.modulus > 0.0)) {
        return fail(ErrorKind::noResult,
                    "the surface cannot be flattened: its coordinates leave its equations without "
                    "a finite solution");
    }
    const double sign = signedArea(tube, topology.cornerTurns, u, v) < 0.0 ? -1.0 : 1.0;
    made.map = periodicMap(tube, topology.cornerTurns, u, v, made.modulus, sign);
    if (options.repairFlips) made.repaired = repair(made.map, tube);
    report(1.0);
    return made;
}

}  // namespace haustra::flatten
