#include "coverage/fisheye_lens.h"

#include "coverage/lens_projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace haustra::coverage {
namespace {

/// How far a projection reaches; short of where it is infinite.
double reachOf(Projection projection) {
    constexpr double pi = std::numbers::pi;
    switch (projection) {
        case Projection::stereographic:
            return pi - 1e-6;
        case Projection::orthogonal:
            return 0.5 * pi;
        case Projection::perspective:
            return 0.5 * pi - 1e-6;
        case Projection::equidistance:
        case Projection::equisolid:
            break;
    }
    return pi;
}

/// s(θ).
double raisedOf(Projection projection, double theta) {
    switch (projection) {
        case Projection::stereographic:
            return 2.0 * std::tan(0.5 * theta);
        case Projection::equisolid:
            return 2.0 * std::sin(0.5 * theta);
        case Projection::orthogonal:
            return std::sin(theta);
        case Projection::perspective:
            return std::tan(theta);
        case Projection::equidistance:
            break;
    }
    return theta;
}

/// θ of s(θ).
double angleOfRaised(Projection projection, double s) {
    switch (projection) {
        case Projection::stereographic:
            return 2.0 * std::atan(0.5 * s);
        case Projection::equisolid:
            return 2.0 * std::asin(std::min(1.0, 0.5 * s));
        case Projection::orthogonal:
            return std::asin(std::min(1.0, s));
        case Projection::perspective:
            return std::atan(s);
        case Projection::equidistance:
            break;
    }
    return s;
}

double valueAt(std::span<const double> polynomial, double t) {
    double value = 0.0;
    for (std::size_t n = polynomial.size(); n-- > 0;)
        value = value * t + polynomial[n];
    return value;
}

/// Where a polynomial, lowest power first, changes its sign within (0, high), in order: between any
/// two such places of its derivative there is at most one. The last argument that has the old sign.
std::vector<double> signChanges(std::span<const double> polynomial, double high) {
    if (polynomial.size() < 2) return {};
    std::vector<double> derivative;
    for (std::size_t n = 1; n < polynomial.size(); ++n)
        derivative.push_back(double(n) * polynomial[n]);
    std::vector<double> ends = signChanges(derivative, high), changes;
    ends.push_back(high);
    double from = 0.0;
    for (const double to : ends) {
        double low = from, above = to;
        from = to;
        const bool positive = valueAt(polynomial, low) > 0.0;
        if ((valueAt(polynomial, above) > 0.0) == positive) continue;
        while (true) {
            const double middle = 0.5 * (low + above);
            if (!(middle > low && middle < above)) break;
            ((valueAt(polynomial, middle) > 0.0) == positive ? low : above) = middle;
        }
        changes.push_back(low);
    }
    return changes;
}

/// dr/ds as a polynomial of s².
std::array<double, 5> slopeOf(const FisheyeLens& lens) {
    std::array<double, 5> slope;
    for (std::size_t n = 0; n < slope.size(); ++n)
        slope[n] = double(2 * n + 1) * lens.k[n];
    return slope;
}

/// The largest s to which r grows; s grows with θ as far as any projection reaches.
double largestRaised(const FisheyeLens& lens) {
    if (!(lens.k[0] > 0.0)) return 0.0;
    const double reach = raisedOf(lens.projection, reachOf(lens.projection));
    if (std::all_of(lens.k.begin() + 1, lens.k.end(), [](double k) { return k == 0.0; }))
        return reach;
    const auto changes = signChanges(slopeOf(lens), reach * reach);
    return changes.empty() ? reach : std::sqrt(changes.front());
}

double radiusOfRaised(const FisheyeLens& lens, double s) {
    return s * valueAt(lens.k, s * s);
}

/// s of a radius.
std::optional<double> raisedOfRadius(const FisheyeLens& lens, double radius) {
    double low = 0.0, high = largestRaised(lens);
    if (!(radius >= 0.0 && radius <= radiusOfRaised(lens, high))) return std::nullopt;
    const auto slope = slopeOf(lens);
    double s = std::min(radius / lens.k[0], high);
    for (int step = 0; step < 200; ++step) {
        const double excess = radiusOfRaised(lens, s) - radius;
        (excess > 0.0 ? high : low) = s;
        const double newton = s - excess / valueAt(slope, s * s);
        const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
        if (std::abs(next - s) < 1e-14 * std::max(1.0, s)) return next;
        s = next;
    }
    return s;
}

/// What decentring adds to a point of (a, b), over k₁.
glm::dvec2 decentred(const FisheyeLens& lens, glm::dvec2 at) {
    const auto [p, q] = lens.decentring;
    const double t = glm::dot(at, at), ab = 2.0 * at.x * at.y;
    return {p * ab + q * (t + 2.0 * at.x * at.x), p * (t + 2.0 * at.y * at.y) + q * ab};
}

}  // namespace

double radiusOf(const FisheyeLens& lens, double theta) {
    return radiusOfRaised(lens, raisedOf(lens.projection, theta));
}

double largestAngle(const FisheyeLens& lens) {
    return std::min(angleOfRaised(lens.projection, largestRaised(lens)), reachOf(lens.projection));
}

std::optional<double> angleOf(const FisheyeLens& lens, double radius) {
    const auto s = raisedOfRadius(lens, radius);
    if (!s) return std::nullopt;
    return angleOfRaised(lens.projection, *s);
}

std::optional<glm::dvec2> pixelOf(const FisheyeLens& lens, glm::dvec3 direction) {
    const double aside = std::hypot(direction.x, direction.y);
    if (!(aside > 0.0 || direction.z > 0.0)) return std::nullopt;
    if (std::atan2(aside, direction.z) > largestAngle(lens)) return std::nullopt;
    // Straight backwards there is no azimuth.
    if (aside < -1e-100 * direction.z)
        return glm::dvec2(lens.mu * radiusOf(lens, std::numbers::pi) + lens.u0, lens.v0);
    const std::array pixelsPerMm{lens.mu, lens.mv}, center{lens.u0, lens.v0};
    glm::dvec2 pixel;
    projectTo(lens.projection, lens.k.data(), pixelsPerMm.data(), center.data(),
              lens.decentring.data(), direction.x, direction.y, direction.z, &pixel.x);
    return pixel;
}

std::optional<glm::dvec3> directionOf(const FisheyeLens& lens, glm::dvec2 pixel) {
    const glm::dvec2 shown((pixel.x - lens.u0) / lens.mu, (pixel.y - lens.v0) / lens.mv);
    glm::dvec2 at(0.0);  // s·(cos φ, sin φ)
    for (int step = 0; step < 100; ++step) {
        const glm::dvec2 radial = shown - lens.k[0] * decentred(lens, at);
        const double radius = std::hypot(radial.x, radial.y);
        const auto s = raisedOfRadius(lens, radius);
        if (!s) return std::nullopt;
        const glm::dvec2 next = radius > 0.0 ? radial * (*s / radius) : glm::dvec2(0.0);
        const bool settled = glm::distance(next, at) < 1e-14 * std::max(1.0, *s);
        at = next;
        if (!settled && lens.decentring != std::array{0.0, 0.0}) continue;
        const double theta = angleOfRaised(lens.projection, *s);
        if (radius == 0.0) return glm::dvec3(0.0, 0.0, 1.0);
        return glm::dvec3(radial * (std::sin(theta) / radius), std::cos(theta));
    }
    return std::nullopt;
}

Result<void> checkLens(const FisheyeLens& lens) {
    for (const double number : {lens.k[0], lens.k[1], lens.k[2], lens.k[3], lens.k[4], lens.mu,
                                lens.mv, lens.u0, lens.v0, lens.decentring[0], lens.decentring[1]})
        if (!std::isfinite(number))
            return fail(ErrorKind::badInput, "a lens has a number that is not finite");
    if (!(lens.mu > 0.0 && lens.mv > 0.0))
        return fail(ErrorKind::badInput, "a lens needs pixels per millimetre over 0");
    if (!(lens.k[0] > 0.0))
        return fail(ErrorKind::badInput, "a lens needs a radius that grows from its axis");
    return {};
}

}  // namespace haustra::coverage
