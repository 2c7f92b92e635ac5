#include "flatten/tube/conjugate_gradient.h"

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
    IteratedSolution made{heldValues(topology, vertices)};
    IteratedVector outcomes[2];
    parallelFor(2, 1, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            const TubeSystem system =
                tubeSystem(mesh, topology, vertices, n == 0 ? TubeFunction::u : TubeFunction::v);
            outcomes[n] = conjugateGradient(system.matrix, system.right, options);
            system.place(outcomes[n].x, n == 0 ? made.values.u : made.values.v);
        }
    });
    made.iterations = outcomes[0].iterations + outcomes[1].iterations;
    made.converged = outcomes[0].converged && outcomes[1].converged;
    return made;
}

}  // namespace haustra::flatten
