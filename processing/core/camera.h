// A camera in the patient, and how its rays spread.
#pragma once

#include "core/result.h"

#include <optional>

#include <glm/glm.hpp>

namespace haustra {

/// How a camera's rays spread over its picture; y is the distance of a pixel from the picture's
/// middle in half heights of the picture.
enum class Lens {
    perspective,   ///< tan θ = y · tan(fov / 2)
    fisheye,       ///< θ = y · fov / 2, equidistant; black beyond θ = 180°
    orthographic,  ///< rays are parallel, y · heightMm / 2 beside the camera
};

/// A camera in patient space (LPS mm). The field of view is vertical. `forward` and `up` need not
/// be unit or orthogonal, only finite and not parallel.
struct Camera {
    glm::dvec3 positionMm{0.0};
    glm::dvec3 forward{0.0, 0.0, 1.0};
    glm::dvec3 up{0.0, -1.0, 0.0};
    double fovDegrees = 90.0;  ///< perspective 1…170, fisheye 1…360
    Lens lens = Lens::perspective;
    double heightMm = 100.0;  ///< of an orthographic picture, over 0
    bool operator==(const Camera&) const = default;
};

/// All three numbers are.
bool isFinite(glm::dvec3 v);

/// Says (badInput) what is wrong with a camera: field of view, height, directions finite and not
/// parallel.
Result<void> checkCamera(const Camera& camera);

/// The unit direction in which a camera that has passed its check sees the place of its picture
/// that lies so many heights of the picture from its middle, x to the right and y down. None where
/// a fisheye shows nothing, and of an orthographic camera, whose rays have one direction and begin
/// beside it.
std::optional<glm::dvec3> rayThrough(const Camera& camera, glm::dvec2 heightsFromMiddle);

}  // namespace haustra
