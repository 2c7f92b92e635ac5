#include "flatten/conjugate_gradient.h"

#include "core/parallel.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace haustra::flatten {
namespace {

using Lower = Eigen::SparseMatrix<double>;
using Full = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

template <class Preconditioner>
IteratedVector solveWith(const Full& matrix, const std::vector<double>& right,
                         const IterationOptions& options) {
    Eigen::ConjugateGradient<Full, Eigen::Lower | Eigen::Upper, Preconditioner> solver;
    solver.setTolerance(options.tolerance);
    if (options.maxIterations > 0) solver.setMaxIterations(options.maxIterations);
    solver.compute(matrix);
    IteratedVector made{std::vector<double>(right.size())};
    Vector::Map(made.x.data(), matrix.rows()) =
        solver.solve(Vector::Map(right.data(), matrix.rows()));
    made.iterations = int(solver.iterations());
    made.converged = solver.info() == Eigen::Success;
    return made;
}

}  // namespace

IteratedVector conjugateGradient(const SymmetricMatrix& matrix, const std::vector<double>& right,
                                 const IterationOptions& options) {
    const Eigen::Map<const Lower> lower(matrix.size, matrix.size, Eigen::Index(matrix.row.size()),
                                        matrix.columnStart.data(), matrix.row.data(),
                                        matrix.value.data());
    // Whole rows are multiplied faster than halves that are added up twice.
    const Full full = lower.selfadjointView<Eigen::Lower>();
    return options.jacobi ? solveWith<Eigen::DiagonalPreconditioner<double>>(full, right, options)
                          : solveWith<Eigen::IdentityPreconditioner>(full, right, options);
}

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
    IteratedVector outcomes[2];
    std::vector<int> vertexOf[2];
    parallelFor(2, 1, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            std::vector<int> unknownOf(vertices, -1);
            for (const int v : topology.breadthFirst) {
                if (n == 0 ? onRim[std::size_t(v)] != 0 : v == topology.rims[1].back()) continue;
                unknownOf[std::size_t(v)] = int(vertexOf[n].size());
                vertexOf[n].push_back(v);
            }
            const int size = int(vertexOf[n].size());
            outcomes[n] =
                conjugateGradient(cotangentLaplacian(mesh, unknownOf, size),
                                  n == 0 ? pullOfFixed(mesh, unknownOf, size, made.values.u)
                                         : pullOfTurns(mesh, unknownOf, size),
                                  options);
        }
    });
    for (std::size_t n = 0; n < 2; ++n) {
        std::vector<double>& values = n == 0 ? made.values.u : made.values.v;
        for (std::size_t i = 0; i < vertexOf[n].size(); ++i)
            values[std::size_t(vertexOf[n][i])] = outcomes[n].x[i];
    }
    made.iterations = outcomes[0].iterations + outcomes[1].iterations;
    made.converged = outcomes[0].converged && outcomes[1].converged;
    return made;
}

}  // namespace haustra::flatten
