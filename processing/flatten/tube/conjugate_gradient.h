// The tube's harmonic problems by iteration: what Cholesky is measured beside.
#pragma once

#include "flatten/tube/tube_systems.h"

namespace haustra::flatten {

struct IterationOptions {
    bool jacobi = true;        ///< the diagonal as the preconditioner, or none
    double tolerance = 1e-10;  ///< relative residual
    int maxIterations = 0;     ///< of each system; 0: twice its unknowns
    int threads = 0;           ///< the two systems are solved side by side where there are two
};

struct IteratedVector {
    std::vector<double> x;
    int iterations = 0;
    bool converged = true;
};

/// Conjugate gradients from 0 on a symmetric system that is positive definite, or only semidefinite
/// where `right` is in its range. One thread.
IteratedVector conjugateGradient(const SymmetricMatrix& matrix, const std::vector<double>& right,
                                 const IterationOptions& options);

struct IteratedSolution {
    TubeSolution values;
    int iterations = 0;  ///< of both systems
    bool converged = true;
};

/// As solveTube, by conjugate gradients.
IteratedSolution iterateTube(const IntrinsicMesh& mesh, const TubeTopology& topology,
                             std::size_t vertices, const IterationOptions& options);

}  // namespace haustra::flatten
