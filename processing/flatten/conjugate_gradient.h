// Iterative solution of the Laplacian's systems: what Cholesky is measured beside.
#pragma once

#include "flatten/cotangent_laplacian.h"

#include <vector>

namespace haustra::flatten {

struct IterativeSolution {
    std::vector<double> x;
    int iterations = 0;
    bool converged = false;
};

/// The system of the first right.size() unknowns, by conjugate gradients with the diagonal as the
/// preconditioner (`jacobi`) or without one, to a relative residual of `tolerance` or for
/// `maxIterations` (0: twice the unknowns).
IterativeSolution conjugateGradient(const SymmetricMatrix& matrix, const std::vector<double>& right,
                                    bool jacobi, double tolerance, int maxIterations);

}  // namespace haustra::flatten
