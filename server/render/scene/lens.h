// How a camera's lens spreads its rays over the picture; shaders/lens.glsl says the same, and
// native/lens-inl.h for packets of rays.
#pragma once

#include "core/camera.h"

#include <optional>

#include <glm/glm.hpp>

namespace haustra::render {

/// A camera's axes, in patient space.
struct LensFrame {
    Lens lens;
    glm::dvec3 ahead;        ///< unit
    glm::dvec3 right, down;  ///< from the picture's centre to its right and its bottom edge: at
                             ///< depth 1 (perspective), as long as its angle in radians (fisheye),
                             ///< or the way itself in mm (orthographic)
};
/// Of a picture `aspect` times as wide as high. The camera must have passed its check.
LensFrame lensFrame(const Camera& camera, double aspect);

/// Where a ray begins, and its unit direction; mm in patient space.
struct LensRay {
    glm::dvec3 fromEye, direction;
};
/// Through a place of the picture, −1…1 along both sides; none where a fisheye's shows nothing:
/// more than half a turn from its axis.
std::optional<LensRay> lensRay(const LensFrame& frame, glm::dvec2 place);

}  // namespace haustra::render
