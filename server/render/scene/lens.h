// How a camera's lens spreads its rays over the picture; shaders/lens.glsl says the same, and
// native/lens-inl.h for packets of rays.
#pragma once

#include "core/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
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
inline std::optional<LensRay> lensRay(const LensFrame& frame, glm::dvec2 place) {
    const glm::dvec3 aside = place.x * frame.right + place.y * frame.down;
    switch (frame.lens) {
        case Lens::perspective:
            return LensRay{glm::dvec3(0.0), glm::normalize(frame.ahead + aside)};
        case Lens::fisheye: {
            const double angle = glm::length(aside);
            if (angle > std::numbers::pi) return std::nullopt;
            return LensRay{glm::dvec3(0.0), std::cos(angle) * frame.ahead +
                                                std::sin(angle) / std::max(angle, 1e-9) * aside};
        }
        default:
            return LensRay{aside, frame.ahead};
    }
}

}  // namespace haustra::render
