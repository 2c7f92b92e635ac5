// Both of a tube's harmonic problems by two factorisations of half of it, side by side.
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "flatten/intrinsic_delaunay.h"
#include "flatten/tube_topology.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace haustra::flatten {

/// Values per vertex of the mesh.
struct TubeSolution {
    std::vector<double> u;  ///< 0 on the first rim, 1 on the second
    std::vector<double> v;  ///< with the turns, of period 1; one rim vertex is at 0
};

/// The tube is cut in two by a ring of vertices (a breadth-first level), which are solved for once
/// what lies to either side is eliminated (Schur complements). Within a half the vertices inside
/// come before those on its rim: the factor for v, whose ends are free, then begins with that for
/// u, whose ends are held, and what the rim adds to the Schur complement can be told apart. So one
/// factorisation of each half serves both problems. `vertices` is the mesh's number of them;
/// `factored` is called between factorisation and solution. The result does not depend
/// on `threads`. Fails as SparseCholesky does.
Result<TubeSolution> solveTube(const IntrinsicMesh& mesh, const TubeTopology& topology,
                               std::size_t vertices, int threads,
                               const std::function<void()>& factored = {});

}  // namespace haustra::flatten
