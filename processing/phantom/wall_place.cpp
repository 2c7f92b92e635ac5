#include "phantom/wall_place.h"

#include <cmath>

namespace haustra::phantom {
namespace {

glm::dvec3 gradient(const ColonShape& shape, glm::dvec3 p) {
    constexpr double h = 0.6;
    glm::dvec3 g;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0.0);
        step[axis] = h;
        g[axis] = shape.evaluate(p + step).lumenMm - shape.evaluate(p - step).lumenMm;
    }
    return g;
}

}  // namespace

std::optional<WallPlace> castToWall(const ColonShape& shape, double arcMm, double angle) {
    const PathSample s = shape.path().at(arcMm);
    const glm::dvec3 direction = std::cos(angle) * s.normal + std::sin(angle) * s.binormal;
    if (s.radiusMm < 8.0 || shape.evaluate(s.position).lumenMm > -3.0) return std::nullopt;
    double lo = 0.0, hi = 0.0;
    while (shape.evaluate(s.position + hi * direction).lumenMm < 0.0) {
        lo = hi;
        hi += 0.7;
        if (hi > 45.0) return std::nullopt;
    }
    for (int round = 0; round < 12; ++round) {
        const double middle = 0.5 * (lo + hi);
        (shape.evaluate(s.position + middle * direction).lumenMm < 0.0 ? lo : hi) = middle;
    }
    WallPlace place;
    place.at = s.position + lo * direction;
    const glm::dvec3 g = gradient(shape, place.at);
    if (glm::length(g) < 0.3) return std::nullopt;
    place.inward = -glm::normalize(g);
    const glm::dvec3 across = glm::cross(place.inward, direction);
    place.tangent = glm::length(across) > 0.1
                        ? glm::normalize(across)
                        : glm::normalize(glm::cross(place.inward, s.binormal));
    place.arcMm = arcMm;
    place.radiusMm = s.radiusMm;
    return place;
}

}  // namespace haustra::phantom
