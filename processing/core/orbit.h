// A view from outside: a camera that circles a place and looks at it.
#pragma once

#include "core/camera.h"

#include <glm/glm.hpp>

namespace haustra {

/// Without perspective, upright: the patient's head is up at elevation 0.
struct Orbit {
    glm::dvec3 centerMm{0.0};  ///< in the picture's middle; patient coordinates, LPS
    double radiusMm = 500.0;   ///< from the centre to the camera
    /// 0: from the patient's front, 90: from the patient's left, 180: from behind.
    double azimuthDegrees = 0.0;
    double elevationDegrees = 0.0;  ///< −90: from the feet; 90: from above the head
    double heightMm = 500.0;        ///< of the picture
    bool operator==(const Orbit&) const = default;
};

/// Where it stands, its directions unit and orthogonal, through an orthographic lens.
Camera cameraOf(const Orbit& orbit);

/// The pixel (x to the right, y down, centres at halves) of a picture of `size` where a point
/// appears to such a camera, and how far before it the point is, mm.
glm::dvec3 projected(const Camera& orthographic, glm::dvec3 pointMm, glm::dvec2 size);
inline glm::dvec3 projected(const Orbit& orbit, glm::dvec3 pointMm, glm::dvec2 size) {
    return projected(cameraOf(orbit), pointMm, size);
}

/// From the front, with the box [low, high] whole in a picture that is `aspect` times as wide as
/// high, from whichever side it is then looked at, and a twelfth of the picture free around it; the
/// camera stands outside of anything within the box's length of its centre.
Orbit orbitAround(glm::dvec3 lowMm, glm::dvec3 highMm, double aspect);

}  // namespace haustra
