// The conformal map of a closed surface of genus one to a parallelogram (dissertation §4.2.2.3).
#pragma once

#include "flatten/general/fundamental_domain.h"

namespace haustra::flatten {

/// A closed surface of genus one over the plane: its universal cover modulo the lattice of 1 and τ.
struct TorusMap {
    /// The ratio of two periods: |Re τ| ≤ ½, |τ| ≥ 1, Im τ > 0. It alone tells the conformal class.
    std::complex<double> tau;
    /// The surface cut along its trajectories; `flat` is in the parallelogram 0, 1, 1 + τ, τ, and
    /// in units of the shortest period. The two sides of each cut are 1 or τ apart.
    FundamentalDomain domain;
    double certificate = 0.0;  ///< as in HolomorphicBasis
};

/// Integrates the holomorphic form over the surface, traces the trajectories through the vertex
/// `base` (−1: one whose triangles are among the largest in the plane) along 1 (horizontal) and τ
/// (vertical where τ is imaginary; then the parallelogram is a rectangle), and cuts along them.
/// Fails (badInput) where the surface is not closed, manifold and in one piece of genus one or no
/// triangle uses `base`, and as holomorphicBasis and traceTrajectory.
Result<TorusMap> torusMap(const TriMesh& torus, int base = -1,
                          const HolomorphicOptions& options = {});

/// τ of a basis of genus one, and the form whose shortest period is 1.
struct PeriodRatio {
    std::complex<double> tau;
    ComplexForm form;
};
PeriodRatio periodRatio(const HolomorphicBasis& basis);

}  // namespace haustra::flatten
