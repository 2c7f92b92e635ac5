// Which part of a picture a lens fills.
#pragma once

#include "coverage/fisheye_lens.h"

#include <glm/glm.hpp>

namespace haustra::coverage {

/// The open part of pictures of one endoscope: an ellipse with its axes along the pictures'.
struct FieldEllipse {
    glm::dvec2 center{0.0}, radii{0.0};  ///< pixels
};

/// The ellipse about the picture's middle through its corners: a picture that is open throughout.
FieldEllipse wholePicture(glm::ivec2 size);
/// The widest field that a lens shows within the ellipse and the picture, degrees.
double fieldWithin(const FisheyeLens& lens, const FieldEllipse& open, glm::ivec2 pictureSize);

}  // namespace haustra::coverage
