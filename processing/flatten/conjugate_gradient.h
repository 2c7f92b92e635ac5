// The tube's harmonic problems by iteration: what Cholesky is measured beside.
#pragma once

#include "flatten/tube_solver.h"

namespace haustra::flatten {

struct IterationOptions {
    bool jacobi = true;        ///< the diagonal as the preconditioner, or none
    double tolerance = 1e-10;  ///< relative residual
    int maxIterations = 0;     ///< of each system; 0: twice its unknowns
    int threads = 0;           ///< the two systems are solved side by side where there are two
};

struct IteratedSolution {
    TubeSolution values;
    int iterations = 0;  ///< of both systems
    bool converged = true;
};

/// As solveTube, by conjugate gradients.
IteratedSolution iterateTube(const IntrinsicMesh& mesh, const TubeTopology& topology,
                             std::size_t vertices, const IterationOptions& options);

}  // namespace haustra::flatten
