// A soap film across a part of the wall: the wall as it would be without what stands there.
#pragma once

#include "cad/lesion.h"
#include "cad/wall_samples.h"

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::cad {

/// Finds places for the numbered samples so that each is the mean of its neighbours, while all
/// other samples stay where they are. At least one sample is numbered, and each connected part of
/// the numbered ones has a neighbour that is not among them. Immutable.
///
/// By conjugate gradients on the graph's Laplacian A, in single precision, in coordinates relative
/// to the first sample: heights are asked for to a hundredth of a millimetre. The number of steps
/// grows with the film's width in samples, so that a film of `largeFilm` samples and more is
/// preconditioned on two levels, M⁻¹ = D⁻¹ + Z (ZᵀAZ)⁻¹ Zᵀ: D is A's diagonal, and Z lets
/// aggregates of neighbouring samples move as one (the coarse space of Nicolaides, SIAM J Numer
/// Anal 1987; 24: 355).
class Membrane {
public:
    static constexpr std::uint32_t largeFilm = 3000;

    Membrane(const WallSamples& wall, const SampleNumbers& inside);
    /// Patient coordinates.
    glm::dvec3 at(std::uint32_t number) const { return origin_ + glm::dvec3(places_[number]); }
    /// How many steps of conjugate gradients it took.
    int steps() const { return steps_; }

private:
    using Field = std::vector<glm::vec4>;  // the fourth of each is 0
    class Coarse;

    glm::vec4 times(const Field& field, Field& product) const;
    void span(Coarse* coarse);

    glm::dvec3 origin_;
    Field places_, pull_;
    std::vector<std::uint32_t> begin_, links_;
    std::vector<float> degrees_;
    int steps_ = 0;
};

}  // namespace haustra::cad
