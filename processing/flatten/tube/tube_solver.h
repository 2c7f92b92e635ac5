// Both of a tube's harmonic problems by two factorisations of half of it, side by side.
#pragma once

#include "core/result.h"
#include "flatten/tube/tube_systems.h"

#include <cstddef>
#include <functional>

namespace haustra::flatten {

/// How the unknowns are eliminated; `suited` is the cheaper of the others.
enum class Elimination { suited, byHalves, separately };

/// The tube is cut in two by a ring of vertices (a breadth-first level), which are solved for once
/// what lies to either side is eliminated (Schur complements). Within a half the vertices inside
/// come before those on its rim: the factor for v, whose ends are free, then begins with that for
/// u, whose ends are held, and what the rim adds to the Schur complement can be told apart. So one
/// factorisation of each half serves both problems. What is kept for the rim and the ring is dense:
/// where they are long, u and v are solved for separately, with a factor each, side by side.
/// `vertices` is the mesh's number of them; `factored` is called between factorisation and
/// solution. The result does not depend on `threads`. Fails as SparseCholesky does.
Result<TubeSolution> solveTube(const IntrinsicMesh& mesh, const TubeTopology& topology,
                               std::size_t vertices, int threads,
                               const std::function<void()>& factored = {},
                               Elimination elimination = Elimination::suited);

}  // namespace haustra::flatten
