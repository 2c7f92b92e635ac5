// The colon's centerline: the path that a reader flies along.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// One sample. Samples lie about 1 mm apart from the rectum (arc 0) to the cecum.
struct CenterlinePoint {
    glm::dvec3 positionMm{0.0};  ///< patient coordinates, LPS
    double arcMm = 0.0;          ///< length along the path from the rectum
    double radiusMm = 0.0;       ///< distance to the lumen's boundary here; 0 in a gap
    bool gap = false;            ///< the path crosses from one segment of the colon to the next
};

struct Centerline {
    std::vector<CenterlinePoint> points;
    double lengthMm() const { return points.empty() ? 0.0 : points.back().arcMm; }
};

/// A place on the centerline with its direction of travel (unit, rectum to cecum).
struct CenterlinePose {
    CenterlinePoint point;
    glm::dvec3 tangent{0.0, 0.0, 1.0};
};

/// Position by linear interpolation at `arcMm` (clamped to the ends); the tangent is the chord
/// over `windowMm` to either side, so that a camera along it does not shake. Needs at least one
/// point; O(log n).
CenterlinePose poseAtArc(const Centerline& centerline, double arcMm, double windowMm = 4.0);

/// Arc of the sample nearest to a patient point. Needs at least one point; O(n).
double nearestArc(const Centerline& centerline, glm::dvec3 positionMm);

/// An up vector at each sample, orthogonal to the tangent and carried along the path without
/// twist (double-reflection method, Wang et al. 2008), starting as near to `preferredUp` as the
/// first tangent allows. Same length as `centerline.points`.
std::vector<glm::dvec3> rotationMinimizingUps(const Centerline& centerline, glm::dvec3 preferredUp);

/// Antegrade: from the rectum to the cecum, as the path runs; retrograde: back.
enum class FlightDirection { antegrade, retrograde };

/// Up of a fly-through camera where the path leaves it a choice: anterior, as a patient on the back
/// sees the ceiling.
inline constexpr glm::dvec3 flightPreferredUp{0.0, -1.0, 0.0};

/// Where a camera on the centerline stands and looks. `forward` and `up` are unit and orthogonal.
struct CenterlineCamera {
    glm::dvec3 positionMm{0.0};
    glm::dvec3 forward{0.0, 0.0, 1.0};
    glm::dvec3 up{0.0, -1.0, 0.0};
};

/// How far along the path a fly-through camera looks.
inline constexpr double flightLookAheadMm = 20.0;

/// The camera at `arcMm` (clamped to the ends): looks at the path's place flightLookAheadMm farther
/// on, along the tangent of poseAtArc where the path ends before; up is that of the nearest sample
/// in `ups`, made orthogonal to the view. `ups` is
/// rotationMinimizingUps(centerline, flightPreferredUp); whoever draws a fly-through uses this one
/// function, so equal arcs give equal pictures. Needs at least one point; O(log n).
CenterlineCamera cameraAtArc(const Centerline& centerline, const std::vector<glm::dvec3>& ups,
                             double arcMm, FlightDirection direction);

}  // namespace haustra
