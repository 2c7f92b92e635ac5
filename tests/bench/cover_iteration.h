// A tube's harmonic forms the dissertation's way: on its double cover, by conjugate gradients.
#pragma once

#include "core/tri_mesh.h"
#include "flatten/tube/conjugate_gradient.h"
#include "process_cost.h"

namespace haustra::bench {

struct CoverIteration {
    Cost cost;           ///< of the two systems alone, assembly included
    int iterations = 0;  ///< of both systems
    bool converged = true;
    double certificate = 0.0;  ///< E(u)·E(v) − 1, as of flatten::conformalTube
};

/// Dissertation §4.2.2.1 and 4.2.2.2 up to equation 4.2, on the surface's own triangles, no vertex
/// held. The two forms of the torus are found side by side where there are two threads. The
/// dissertation rotates them; nothing here does. Ends the program where `tube` is no tube.
CoverIteration iterateCover(const TriMesh& tube, const flatten::IterationOptions& options);

}  // namespace haustra::bench
