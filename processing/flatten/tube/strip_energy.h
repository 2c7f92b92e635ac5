// What a flat map costs that is to keep angles and areas.
#pragma once

#include "core/tri_mesh.h"
#include "flatten/periodic_map.h"

#include <array>
#include <complex>
#include <vector>

namespace haustra::flatten {

/// The mean over the surface of
///   angle · (cosh ln(σ₁/σ₂) − 1) + area · (cosh ln(scale · σ₁σ₂) − 1),
/// σ₁ ≥ σ₂ being each triangle's stretches from surface to plane: Degener, Meseth and Klein (2003),
/// *An adaptable surface parameterization method*, with a sum for their product; past a ratio of
/// ten either term grows as the logarithm alone. `scale` is what makes the mean least, so that only
/// differences of area count. It is 0 for an isometry up to scale, and grows without bound before a
/// triangle flips.
class StripEnergy {
public:
    struct Weights {
        double angle = 1.0, area = 0.0;
    };
    /// Of one triangle, by its corners' x₀ y₀ x₁ y₁ x₂ y₂.
    struct Derivatives {
        std::array<double, 6> gradient;
        /// Lower triangle by rows, of the nearest positive semidefinite matrix at a given scale.
        std::array<double, 21> hessian;
        std::array<double, 6> scaleMixed;  ///< ∂²/∂ln scale ∂corner
    };

    /// A triangle of next to no area is held to its shape in `start`. The mesh must outlive this.
    StripEnergy(const TriMesh& tube, const PeriodicMap& start, Weights weights, int threads);

    void weigh(Weights weights) { weights_ = weights; }

    /// Infinite where a triangle has no positive area. `flat` is per vertex, x unrolled as the
    /// start's turns want it. The same for any number of threads, as are the derivatives.
    double value(const std::vector<glm::dvec2>& flat);
    /// At the last `flat` that `value` was given and found finite, per triangle.
    const std::vector<Derivatives>& derivatives(const std::vector<glm::dvec2>& flat);
    /// Flat area over area, per triangle, at the last `flat` that `value` was given.
    const std::vector<double>& stretch() const { return stretch_; }
    /// ∂²/∂ln scale² there.
    double scaleCurvature() const { return scaleCurvature_; }
    /// How far along `step` (per vertex) the first triangle loses its area (Smith and Schaefer
    /// 2015); infinite where none does.
    double firstFlip(const std::vector<glm::dvec2>& flat,
                     const std::vector<glm::dvec2>& step) const;

private:
    using Complex = std::complex<double>;
    struct Reference {
        /// ∂/∂z of the corners' hat functions on the surface: f_z = Σ f·hat, f_z̄ = Σ f·conj(hat).
        std::array<Complex, 3> hat;
        double doubleArea;
        double weight;  ///< share of the surface's area
    };

    std::array<glm::dvec2, 3> corners(std::size_t triangle,
                                      const std::vector<glm::dvec2>& flat) const;

    /// The weighted mean of term(triangle), summed in one order.
    template <class Term>
    double mean(const Term& term) const;
    void findScale();

    const TriMesh& tube_;
    std::vector<std::array<std::int8_t, 3>> turns_;
    std::vector<Reference> references_;
    std::vector<double> stretch_;
    std::vector<Derivatives> derivatives_;
    Weights weights_;
    int threads_;
    double scale_ = 1.0;
    double scaleCurvature_ = 0.0;
};

}  // namespace haustra::flatten
