#include "coverage/fisheye_lens.h"

#include <cmath>
#include <numbers>

namespace haustra::coverage {
namespace {

/// dr/dθ.
double slopeOf(const FisheyeLens& lens, double theta) {
    const double t = theta * theta;
    return lens.k[0] + t * (3.0 * lens.k[1] + t * (5.0 * lens.k[2] + t * 7.0 * lens.k[3]));
}

}  // namespace

double radiusOf(const FisheyeLens& lens, double theta) {
    const double t = theta * theta;
    return theta * (lens.k[0] + t * (lens.k[1] + t * (lens.k[2] + t * lens.k[3])));
}

double largestAngle(const FisheyeLens& lens) {
    // The slope is a cubic in θ²: its first root is bracketed by steps much shorter than the
    // distance of its turning points in any lens that is built, then halved.
    constexpr int steps = 720;
    constexpr double step = std::numbers::pi / steps;
    if (!(slopeOf(lens, 0.0) > 0.0)) return 0.0;
    for (int n = 1; n <= steps; ++n) {
        if (slopeOf(lens, n * step) > 0.0) continue;
        double low = (n - 1) * step, high = n * step;
        for (int halving = 0; halving < 60; ++halving) {
            const double middle = 0.5 * (low + high);
            (slopeOf(lens, middle) > 0.0 ? low : high) = middle;
        }
        return low;
    }
    return std::numbers::pi;
}

std::optional<double> angleOf(const FisheyeLens& lens, double radius) {
    double low = 0.0, high = largestAngle(lens);
    if (!(radius >= 0.0 && radius <= radiusOf(lens, high))) return std::nullopt;
    double theta = std::min(radius / lens.k[0], high);
    for (int step = 0; step < 100 && high - low > 1e-13; ++step) {
        const double excess = radiusOf(lens, theta) - radius;
        (excess > 0.0 ? high : low) = theta;
        const double newton = theta - excess / slopeOf(lens, theta);
        const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
        if (std::abs(next - theta) < 1e-13) return next;
        theta = next;
    }
    return theta;
}

std::optional<glm::dvec2> pixelOf(const FisheyeLens& lens, glm::dvec3 direction) {
    const double aside = std::hypot(direction.x, direction.y);
    if (!(aside > 0.0 || direction.z > 0.0)) return std::nullopt;
    const double theta = std::atan2(aside, direction.z);
    if (theta > largestAngle(lens)) return std::nullopt;
    const glm::dvec2 azimuth =
        aside > 0.0 ? glm::dvec2(direction) / aside : glm::dvec2(1.0, 0.0);
    const double radius = radiusOf(lens, theta);
    return glm::dvec2(lens.mu * radius * azimuth.x + lens.u0,
                      lens.mv * radius * azimuth.y + lens.v0);
}

std::optional<glm::dvec3> directionOf(const FisheyeLens& lens, glm::dvec2 pixel) {
    const glm::dvec2 at((pixel.x - lens.u0) / lens.mu, (pixel.y - lens.v0) / lens.mv);
    const double radius = std::hypot(at.x, at.y);
    const auto theta = angleOf(lens, radius);
    if (!theta) return std::nullopt;
    if (radius == 0.0) return glm::dvec3(0.0, 0.0, 1.0);
    return glm::dvec3(at * (std::sin(*theta) / radius), std::cos(*theta));
}

Result<void> checkLens(const FisheyeLens& lens) {
    for (const double number :
         {lens.k[0], lens.k[1], lens.k[2], lens.k[3], lens.mu, lens.mv, lens.u0, lens.v0})
        if (!std::isfinite(number))
            return fail(ErrorKind::badInput, "a lens has a number that is not finite");
    if (!(lens.mu > 0.0 && lens.mv > 0.0))
        return fail(ErrorKind::badInput, "a lens needs pixels per millimetre over 0");
    if (!(lens.k[0] > 0.0))
        return fail(ErrorKind::badInput, "a lens needs a radius that grows from its axis");
    return {};
}

}  // namespace haustra::coverage
