// The tube's map against conjugate gradients, turn by turn.
#pragma once

#include "flatten_meshes.h"

namespace haustra::bench {

struct RaceOptions {
    int threads = 0;
    int rounds = 0;          ///< of every iteration; each is between two maps of ours
    double seconds = 600.0;  ///< an iteration is ended after about so long
};

/// Prints our map's cost, repair included, the first time in a process and the second; and that of
/// conjugate gradients to 1e-10 on the surface's own triangles, with the diagonal and without: of
/// the two systems that the symmetric reduction leaves, as part of a map without repair, and of the
/// double cover's two, alone, as the dissertation has them. Each run has a process of its own, and
/// what else the machine does falls on all in turn; ratios are to the mean of the two maps around.
void raceIterations(const Tube& tube, const RaceOptions& options);

}  // namespace haustra::bench
