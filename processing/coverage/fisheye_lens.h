// Lenses that a tangent does not describe: where a fisheye camera shows a direction (dissertation
// §2.2; Kannala and Brandt, IEEE PAMI 2006;28:1335).
#pragma once

#include "core/result.h"

#include <array>
#include <optional>

#include <glm/glm.hpp>

namespace haustra::coverage {

/// The projections that lenses are designed to: how far from the middle an ideal lens shows a ray
/// that makes the angle θ with its axis, s(θ), in units of the focal length (equations 2.1 to 2.5,
/// each over f; the source prints the orthogonal one as 2f sin θ, twice what it is).
enum class Projection {
    equidistance,   ///< θ
    stereographic,  ///< 2 tan(θ/2)
    equisolid,      ///< 2 sin(θ/2)
    orthogonal,     ///< sin θ; to 90°
    perspective,    ///< tan θ; to less than 90°
};

/// The generic radially symmetric model, equations 2.6 to 2.8: a ray that makes the angle θ with
/// the optical axis, at azimuth φ (x to the right, y down, z forward), is shown at
///     r(θ) = k₁s + k₂s³ + k₃s⁵ + k₄s⁷ + k₅s⁹,  u = m_u · r cos φ + u₀,  v = m_v · r sin φ + v₀
/// with s = θ, or what `projection` makes of it: k₁ alone is then the focal length f of that
/// projection. r in mm on the sensor (k in mm per power of s), m in pixels per mm; pixel centres at
/// whole numbers. Only the products m·k are seen in pictures: scaling k by c and both m by 1/c
/// changes nothing. The source uses k₁ and k₂ alone; OpenCV's fisheye has k₁ = 1 and all others;
/// OpenCV's pinhole is `perspective` with k₁ = 1 and Brown's decentring (p₁, p₂), which moves a
/// point of (a, b) = s·(cos φ, sin φ) by k₁·(2p₁ab + p₂(s² + 2a²), p₁(s² + 2b²) + 2p₂ab).
struct FisheyeLens {
    std::array<double, 5> k{1.0, 0.0, 0.0, 0.0, 0.0};
    double mu = 1.0, mv = 1.0;  ///< over 0
    double u0 = 0.0, v0 = 0.0;
    Projection projection = Projection::equidistance;
    std::array<double, 2> decentring{0.0, 0.0};
    bool operator==(const FisheyeLens&) const = default;
};

/// r(θ), for θ in 0…largestAngle radians.
double radiusOf(const FisheyeLens& lens, double theta);
/// The largest angle up to π to which r grows strictly, and no more than the projection reaches
/// (within 1e-6 rad of where it is infinite): beyond it a picture would fold onto itself.
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
