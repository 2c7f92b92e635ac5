// Lenses that a tangent does not describe: where a fisheye camera shows a direction (dissertation
// §2.2; Kannala and Brandt, IEEE PAMI 2006;28:1335).
#pragma once

#include "core/result.h"

#include <array>
#include <optional>

#include <glm/glm.hpp>

namespace haustra::coverage {

/// The generic radially symmetric model, equations 2.6 to 2.8: a ray that makes the angle θ with
/// the optical axis, at azimuth φ (x to the right, y down, z forward), is shown at
///     r(θ) = k₁θ + k₂θ³ + k₃θ⁵ + k₄θ⁷,    u = m_u · r cos φ + u₀,    v = m_v · r sin φ + v₀.
/// r in mm on the sensor (k in mm per power of a radian), m in pixels per mm; pixel centres at
/// whole numbers. Only the products m·k are seen in pictures: scaling k by s and both m by 1/s
/// changes nothing. The source uses k₁ and k₂ alone.
struct FisheyeLens {
    std::array<double, 4> k{1.0, 0.0, 0.0, 0.0};
    double mu = 1.0, mv = 1.0;  ///< over 0
    double u0 = 0.0, v0 = 0.0;
    bool operator==(const FisheyeLens&) const = default;
};

/// r(θ), for θ in 0…π radians.
double radiusOf(const FisheyeLens& lens, double theta);
/// The largest angle up to π to which r grows strictly: beyond it a picture would fold onto itself.
double largestAngle(const FisheyeLens& lens);
/// θ of r(θ) = radius to 1e-12 rad, by Newton steps kept in a bracket. None where the radius is
/// negative or over r(largestAngle).
std::optional<double> angleOf(const FisheyeLens& lens, double radius);

/// Pixel of a direction in the camera's frame, which need not be unit. None of the zero vector and
/// beyond largestAngle.
std::optional<glm::dvec2> pixelOf(const FisheyeLens& lens, glm::dvec3 direction);
/// The unit direction that a pixel shows; none beyond largestAngle.
std::optional<glm::dvec3> directionOf(const FisheyeLens& lens, glm::dvec2 pixel);

/// Says (badInput) what is wrong: numbers that are not finite, m not over 0, r that does not grow
/// from the axis.
Result<void> checkLens(const FisheyeLens& lens);

}  // namespace haustra::coverage
