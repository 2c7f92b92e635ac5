// The colon's path: the conformal map of a tube, from the symmetric reduction of its double cover
// (dissertation §4.2.2; the reduction: by symmetry the double cover's harmonic forms restrict to a
// harmonic function with constant ends and a harmonic form of period 1 with free ends).
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "flatten/periodic_map.h"

namespace haustra::flatten {

/// How the two sparse systems are solved. Cholesky is what readers get; the others are there to
/// be measured beside it.
enum class Solver { cholesky, conjugateGradient, jacobiConjugateGradient };

struct ConformalTubeOptions {
    int threads = 0;  ///< the two systems are solved side by side where there are two
    Solver solver = Solver::cholesky;
    double tolerance = 1e-10;  ///< relative residual; of the iterative solvers alone
    int maxIterations = 0;     ///< of each system; 0: twice its unknowns
    /// Flips edges until no cotangent weight is negative, in the intrinsic metric (Fisher et al.
    /// 2007). The surface's triangles stay as they are.
    bool intrinsicDelaunay = true;
    /// Repairs what the intrinsic triangulation hides: patches around flipped triangles are
    /// unfolded (flip_repair.h), and vertices of triangles stretched over four times as far one way
    /// as the other, with a ring around them, relaxed (shape_relaxation.h).
    bool repairFlips = true;
    Progress progress;
};

struct ConformalTube {
    PeriodicMap map;
    double modulus = 0.0;      ///< √(E(v)/E(u)): length over circumference, the map's height
    double certificate = 0.0;  ///< E(u)·E(v) − 1 ≥ 0: bounds the modulus's relative error
    int flippedEdges = 0;      ///< by the intrinsic Delaunay triangulation
    int negativeWeights = 0;   ///< edges whose cotangent weight was negative before it
    int repaired = 0;          ///< vertices that repairFlips moved
    int iterations = 0;        ///< of an iterative solver, both systems together
    bool converged = true;
};

/// Harmonic u with 0 on `tube`'s first boundary loop and 1 on the second, harmonic form v of period
/// 1 around it with natural boundary conditions; the map is (v, u·modulus). `firstLoop` is a vertex
/// of the loop that becomes y = 0 (−1: the one with the lowest-numbered vertex). x grows so that
/// triangles keep their orientation. Fails (badInput) where the mesh is not a connected manifold
/// tube with two boundary loops, (noResult) where a triangle without area leaves the system
/// singular. Byte-identical for any number of threads. Seconds for a million triangles, about half
/// a KiB a triangle.
Result<ConformalTube> conformalTube(const TriMesh& tube, int firstLoop = -1,
                                    const ConformalTubeOptions& options = {});

}  // namespace haustra::flatten
