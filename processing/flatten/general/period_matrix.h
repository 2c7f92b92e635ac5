// A closed surface's periods: what tells its conformal structure.
#pragma once

#include "flatten/general/holomorphic_forms.h"

namespace haustra::flatten {

/// Of canonical loops a_1 … a_g, b_1 … b_g (b_i crosses a_i once, from its right to its left;
/// no other two cross in sum) and the holomorphic forms with ∮ form j over a_i = δ_ij.
struct PeriodMatrix {
    /// values[i][j] = ∮ form j over b_i: symmetric with a positive definite imaginary part
    /// (Riemann's bilinear relations), to rounding.
    std::vector<std::vector<std::complex<double>>> values;
    /// Per canonical loop, a first: how often it runs along each loop of the basis.
    std::vector<std::vector<int>> loops;
    /// Per form: the coefficients that HolomorphicBasis::holomorphic takes.
    std::vector<std::vector<std::complex<double>>> forms;
};

/// O(g⁴) at worst.
PeriodMatrix periodMatrix(const HolomorphicBasis& basis);

}  // namespace haustra::flatten
