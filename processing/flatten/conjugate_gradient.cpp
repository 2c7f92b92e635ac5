#include "flatten/conjugate_gradient.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace haustra::flatten {
namespace {

template <class Preconditioner>
IterativeSolution solveWith(const Eigen::SparseMatrix<double>& lower,
                            const std::vector<double>& right, double tolerance, int maxIterations) {
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower, Preconditioner> solver;
    solver.setTolerance(tolerance);
    if (maxIterations > 0) solver.setMaxIterations(maxIterations);
    solver.compute(lower);
    const Eigen::Map<const Eigen::VectorXd> b(right.data(), Eigen::Index(right.size()));
    const Eigen::VectorXd x = solver.solve(b);
    return {{x.begin(), x.end()}, int(solver.iterations()), solver.info() == Eigen::Success};
}

}  // namespace

IterativeSolution conjugateGradient(const SymmetricMatrix& matrix, const std::vector<double>& right,
                                    bool jacobi, double tolerance, int maxIterations) {
    const Eigen::Map<const Eigen::SparseMatrix<double>> whole(
        matrix.size, matrix.size, Eigen::Index(matrix.row.size()), matrix.columnStart.data(),
        matrix.row.data(), matrix.value.data());
    const auto size = Eigen::Index(right.size());
    const Eigen::SparseMatrix<double> lower = whole.topLeftCorner(size, size);
    return jacobi
               ? solveWith<Eigen::DiagonalPreconditioner<double>>(lower, right, tolerance,
                                                                  maxIterations)
               : solveWith<Eigen::IdentityPreconditioner>(lower, right, tolerance, maxIterations);
}

}  // namespace haustra::flatten
