#include "reader/overview_map.h"

#include <algorithm>
#include <cmath>

namespace haustra::reader {

namespace {

constexpr double asNearPixels = 3.0;
/// A wide lumen around the path.
constexpr double wallMm = 30.0;

double away(glm::dvec3 seen, glm::dvec2 pixel) {
    return glm::distance(glm::dvec2(seen), pixel);
}

}  // namespace

std::optional<double> arcAt(const Orbit& orbit, const Centerline& path, glm::dvec2 pixel,
                            glm::dvec2 size, double reach) {
    double nearest = INFINITY;
    for (const CenterlinePoint& point : path.points)
        nearest = std::min(nearest, away(projected(orbit, point.positionMm, size), pixel));
    if (!(nearest <= reach)) return std::nullopt;
    // The nearest to the eye, and of these at one bend the nearest to the pixel.
    const CenterlinePoint* front = nullptr;
    double frontDepth = INFINITY;
    for (const CenterlinePoint& point : path.points) {
        const glm::dvec3 seen = projected(orbit, point.positionMm, size);
        const double distance = away(seen, pixel);
        if (distance > nearest + asNearPixels) continue;
        const double depth = seen.z + 2.0 * (distance - nearest) * orbit.heightMm / size.y;
        if (depth < frontDepth) front = &point, frontDepth = depth;
    }
    return front->arcMm;
}

std::optional<std::size_t> placeAt(const Orbit& orbit, const std::vector<glm::dvec3>& places,
                                   glm::dvec2 pixel, glm::dvec2 size, double reach) {
    std::optional<std::size_t> found;
    double nearest = reach;
    for (std::size_t n = 0; n < places.size(); ++n) {
        const double distance = away(projected(orbit, places[n], size), pixel);
        if (distance <= nearest) found = n, nearest = distance;
    }
    return found;
}

Orbit orbitOf(const Centerline& path, double aspect) {
    if (path.points.empty()) return {};
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const CenterlinePoint& point : path.points) {
        low = glm::min(low, point.positionMm - wallMm);
        high = glm::max(high, point.positionMm + wallMm);
    }
    return orbitAround(low, high, aspect);
}

}  // namespace haustra::reader
