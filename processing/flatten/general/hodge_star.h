// The rotation by a right angle on a surface's harmonic forms.
#pragma once

#include <vector>

namespace haustra::flatten {

using Matrix = std::vector<std::vector<double>>;

struct HodgeStar {
    /// The conjugate of form k is Σ_j star[k][j]·form j. Applied twice it is −1, to rounding.
    Matrix star;
    /// Largest 1/σ² − 1 ≥ 0, σ the lengths that the best combinations have before they are made
    /// rotations: for a tube's double cover this is E(u)·E(v) − 1 of the conformal map.
    double certificate = 0.0;
};

/// From the forms' scalar products ∫ ω_i ∧ *ω_j (symmetric, positive definite) and wedge products
/// ∫ ω_i ∧ ω_j (skew).
///
/// The conjugate (dissertation equation 4.3) rotates a form's vector in each triangle about the
/// normal. What comes out is constant in each triangle but agrees across no edge: it is the
/// gradient of nothing, and averaging it into values on edges leaves it neither closed nor
/// harmonic. The combination of harmonic forms that is nearest to it in the energy is both, and
/// needs the wedge products alone, which are topological: star = wedge · product⁻¹. That is skew
/// for the scalar product, and falls short of a rotation by the discretisation's error, of order
/// h². Its polar factor is the rotation nearest to it; it keeps the wedge products, so that period
/// matrices are symmetric with a positive definite imaginary part to rounding (Riemann's bilinear
/// relations), and for a tube the modulus is √(E(v)/E(u)), whichever form one starts from.
HodgeStar hodgeStar(const Matrix& product, const Matrix& wedge);

}  // namespace haustra::flatten
