#include "core/centerline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haustra {
namespace {

glm::dvec3 positionAt(const std::vector<CenterlinePoint>& points, double arcMm,
                      CenterlinePoint* sample) {
    const auto after =
        std::upper_bound(points.begin(), points.end(), arcMm,
                         [](double arc, const CenterlinePoint& p) { return arc < p.arcMm; });
    const CenterlinePoint& b = after == points.end() ? points.back() : *after;
    const CenterlinePoint& a = after == points.begin() ? points.front() : *(after - 1);
    const double length = b.arcMm - a.arcMm;
    const double t = length > 0.0 ? std::clamp((arcMm - a.arcMm) / length, 0.0, 1.0) : 0.0;
    const glm::dvec3 position = glm::mix(a.positionMm, b.positionMm, t);
    if (sample) {
        sample->positionMm = position;
        sample->arcMm = a.arcMm + t * length;
        sample->radiusMm = (1.0 - t) * a.radiusMm + t * b.radiusMm;
        sample->gap = t < 0.5 ? a.gap : b.gap;
    }
    return position;
}

glm::dvec3 anyNormal(glm::dvec3 direction) {
    const glm::dvec3 axis = std::abs(direction.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    return glm::normalize(glm::cross(direction, axis));
}

}  // namespace

CenterlinePose poseAtArc(const Centerline& centerline, double arcMm, double windowMm) {
    CenterlinePose pose;
    const auto& points = centerline.points;
    positionAt(points, std::clamp(arcMm, 0.0, centerline.lengthMm()), &pose.point);
    const glm::dvec3 chord = positionAt(points, pose.point.arcMm + windowMm, nullptr) -
                             positionAt(points, pose.point.arcMm - windowMm, nullptr);
    if (glm::length(chord) > 1e-9) pose.tangent = glm::normalize(chord);
    return pose;
}

double nearestArc(const Centerline& centerline, glm::dvec3 positionMm) {
    double best = std::numeric_limits<double>::max(), arc = 0.0;
    for (const CenterlinePoint& p : centerline.points) {
        const glm::dvec3 d = p.positionMm - positionMm;
        if (glm::dot(d, d) < best) best = glm::dot(d, d), arc = p.arcMm;
    }
    return arc;
}

std::vector<glm::dvec3> rotationMinimizingUps(const Centerline& centerline,
                                              glm::dvec3 preferredUp) {
    const auto& points = centerline.points;
    std::vector<glm::dvec3> ups(points.size());
    glm::dvec3 tangent(0.0), up(0.0);
    for (std::size_t n = 0; n < points.size(); ++n) {
        const glm::dvec3 next = poseAtArc(centerline, points[n].arcMm).tangent;
        if (n == 0) {
            up = preferredUp - glm::dot(preferredUp, next) * next;
            up = glm::length(up) > 1e-6 ? glm::normalize(up) : anyNormal(next);
        } else {
            const glm::dvec3 step = points[n].positionMm - points[n - 1].positionMm;
            const double c1 = glm::dot(step, step);
            glm::dvec3 reflectedUp = up, reflectedTangent = tangent;
            if (c1 > 1e-18) {
                reflectedUp -= (2.0 / c1) * glm::dot(step, up) * step;
                reflectedTangent -= (2.0 / c1) * glm::dot(step, tangent) * step;
            }
            const glm::dvec3 v = next - reflectedTangent;
            const double c2 = glm::dot(v, v);
            up = c2 > 1e-18 ? reflectedUp - (2.0 / c2) * glm::dot(v, reflectedUp) * v : reflectedUp;
            up -= glm::dot(up, next) * next;
            up = glm::length(up) > 1e-9 ? glm::normalize(up) : anyNormal(next);
        }
        tangent = next;
        ups[n] = up;
    }
    return ups;
}

CenterlineCamera cameraAtArc(const Centerline& centerline, const std::vector<glm::dvec3>& ups,
                             double arcMm, FlightDirection direction) {
    const CenterlinePose pose = poseAtArc(centerline, arcMm);
    const auto& points = centerline.points;
    const auto after =
        std::lower_bound(points.begin(), points.end(), pose.point.arcMm,
                         [](const CenterlinePoint& p, double arc) { return p.arcMm < arc; });
    std::size_t nearest = std::min<std::size_t>(after - points.begin(), points.size() - 1);
    if (nearest > 0 &&
        pose.point.arcMm - points[nearest - 1].arcMm < points[nearest].arcMm - pose.point.arcMm) {
        --nearest;
    }
    const bool antegrade = direction == FlightDirection::antegrade;
    CenterlineCamera camera;
    camera.positionMm = pose.point.positionMm;
    // A wide lumen bends far within its own width: the eye goes to where the path will be.
    const glm::dvec3 ahead =
        positionAt(points, pose.point.arcMm + (antegrade ? flightLookAheadMm : -flightLookAheadMm),
                   nullptr) -
        camera.positionMm;
    camera.forward = glm::length(ahead) > 0.25 * flightLookAheadMm ? glm::normalize(ahead)
                     : antegrade                                   ? pose.tangent
                                                                   : -pose.tangent;
    const glm::dvec3 up = nearest < ups.size() ? ups[nearest] : flightPreferredUp;
    const glm::dvec3 upright = up - glm::dot(up, camera.forward) * camera.forward;
    camera.up = glm::length(upright) > 1e-6 ? glm::normalize(upright) : anyNormal(camera.forward);
    return camera;
}

}  // namespace haustra
