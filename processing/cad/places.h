// Which candidates are of one place, and how sure they make it together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::cad {

/// What a place is told by: a candidate's centre, its diameter, its area and how probable it is by
/// itself.
struct PlaceWitness {
    glm::dvec3 centerMm{0.0};
    double diameterMm = 0.0, areaMm2 = 0.0, probability = 0.0;
    /// Of a patch at another level (otherLevels): the number of the witness whose patch that is.
    std::int32_t levelOf = -1;
};

/// Candidates that are so probable by themselves are looked at at other levels, too.
inline constexpr double worthAnotherLook = 0.1;

/// A place, its most probable witness (of equal ones the larger), and its score: the mean of its
/// three most probable witnesses, where a missing one counts nothing. A polyp is seen at both
/// scales and at each level, noise mostly at one.
struct WitnessedPlace {
    std::size_t best = 0;
    double score = 0.0;
};

/// Whether one centre is nearer to the other than half the larger of the two diameters.
bool isSamePlace(glm::dvec3 oneMm, double oneDiameterMm, glm::dvec3 otherMm,
                 double otherDiameterMm);

/// By the most probable of their witnesses, the greatest first. A witness is of the first place
/// that is the same as its own, by their centres, or of a new one. Other levels of what is not
/// worth another look are no witnesses. O(witnesses · places).
std::vector<WitnessedPlace> placesOf(std::span<const PlaceWitness> witnesses);

/// ln(p / (1 − p)), of probabilities from 1e-6 to 1 − 1e-6.
double logit(double probability);
/// 1 / (1 + e^−x).
double logistic(double x);

}  // namespace haustra::cad
