#include "flatten/conjugate_gradient.h"

#include "core/parallel.h"
#include "flatten/cotangent_laplacian.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace haustra::flatten {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

template <class Preconditioner>
Vector solveWith(const Matrix& lower, const Vector& right, const IterationOptions& options,
                 IteratedSolution& outcome) {
    Eigen::ConjugateGradient<Matrix, Eigen::Lower, Preconditioner> solver;
    solver.setTolerance(options.tolerance);
    if (options.maxIterations > 0) solver.setMaxIterations(options.maxIterations);
    solver.compute(lower);
    const Vector x = solver.solve(right);
    outcome.iterations = int(solver.iterations());
    outcome.converged = solver.info() == Eigen::Success;
    return x;
}

}  // namespace

IteratedSolution iterateTube(const IntrinsicMesh& mesh, const TubeTopology& topology,
                             std::size_t vertices, const IterationOptions& options) {
    // In u the rims are held, in v one of their vertices is.
    std::vector<char> onRim(vertices, 0);
    for (const auto& rim : topology.rims) {
        for (const int v : rim)
            onRim[std::size_t(v)] = 1;
    }
    IteratedSolution made{{std::vector<double>(vertices, 0.0), std::vector<double>(vertices, 0.0)}};
    for (const int v : topology.rims[1])
        made.values.u[std::size_t(v)] = 1.0;
    IteratedSolution outcomes[2];
    parallelFor(2, 1, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            std::vector<int> unknownOf(vertices, -1), vertexOf;
            for (const int v : topology.breadthFirst) {
                if (n == 0 ? onRim[std::size_t(v)] != 0 : v == topology.rims[1].back()) continue;
                unknownOf[std::size_t(v)] = int(vertexOf.size());
                vertexOf.push_back(v);
            }
            const int size = int(vertexOf.size());
            const SymmetricMatrix matrix = cotangentLaplacian(mesh, unknownOf, size);
            const Eigen::Map<const Matrix> lower(size, size, Eigen::Index(matrix.row.size()),
                                                 matrix.columnStart.data(), matrix.row.data(),
                                                 matrix.value.data());
            const std::vector<double> pull = n == 0
                                                 ? pullOfFixed(mesh, unknownOf, size, made.values.u)
                                                 : pullOfTurns(mesh, unknownOf, size);
            const Vector right = Vector::Map(pull.data(), size);
            const Vector x = options.jacobi ? solveWith<Eigen::DiagonalPreconditioner<double>>(
                                                  lower, right, options, outcomes[n])
                                            : solveWith<Eigen::IdentityPreconditioner>(
                                                  lower, right, options, outcomes[n]);
            std::vector<double>& values = n == 0 ? outcomes[n].values.u : outcomes[n].values.v;
            values = n == 0 ? made.values.u : made.values.v;
            for (int i = 0; i < size; ++i)
                values[std::size_t(vertexOf[std::size_t(i)])] = x[i];
        }
    });
    made.values = {std::move(outcomes[0].values.u), std::move(outcomes[1].values.v)};
    made.iterations = outcomes[0].iterations + outcomes[1].iterations;
    made.converged = outcomes[0].converged && outcomes[1].converged;
    return made;
}

}  // namespace haustra::flatten
