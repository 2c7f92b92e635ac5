#include "core/wall_camera.h"

#include <algorithm>
#include <cmath>

namespace haustra {
namespace {

/// Stretch of centerline to either side that tells its direction, as of poseAtArc.
constexpr double windowMm = 4.0;

glm::dvec3 positionAtArc(const FlatMap& map, double arcMm) {
    const auto& cameras = map.cameras;
    const auto after =
        std::lower_bound(cameras.begin(), cameras.end(), arcMm,
                         [](const FlatCamera& camera, double arc) { return camera.arcMm < arc; });
    return after == cameras.end() ? cameras.back().positionMm : after->positionMm;
}

/// `v` without what it has of unit `axis`; zero where nothing is left.
glm::dvec3 across(glm::dvec3 v, glm::dvec3 axis) {
    const glm::dvec3 rest = v - glm::dot(v, axis) * axis;
    const double length = glm::length(rest);
    return length > 1e-3 * glm::length(v) ? rest / length : glm::dvec3(0.0);
}

}  // namespace

CenterlineCamera cameraTowards(const FlatMap& map, const WallPlace& place, glm::dvec3 pointMm) {
    CenterlineCamera camera;
    camera.positionMm = place.cameraMm;
    const glm::dvec3 view = pointMm - place.cameraMm;
    if (glm::length(view) > 0.0) camera.forward = glm::normalize(view);
    const glm::dvec3 towardsCecum =
        positionAtArc(map, place.arcMm + windowMm) - positionAtArc(map, place.arcMm - windowMm);
    // At the path's ends it may look along it; then any up will do.
    for (const glm::dvec3 up : {towardsCecum, flightPreferredUp, glm::dvec3(1.0, 0.0, 0.0)}) {
        camera.up = across(up, camera.forward);
        if (camera.up != glm::dvec3(0.0)) break;
    }
    return camera;
}

}  // namespace haustra
