// The electronic biopsy image of the whole flattened wall (dissertation §6.2.4, fig. 6.5a).
#pragma once

#include "cad/biopsy.h"
#include "core/flat_map.h"
#include "core/image.h"

#include <glm/glm.hpp>

namespace haustra::cad {

/// For each pixel of a StripRaster `finer` times as fine, a ray from its place of the wall along
/// the gradient into the tissue; each pixel is the mean of finer² rays, in linear light. Sides of 1
/// and more. The same for any number of threads.
Image biopsyImage(const BiopsyScan& scan, const FlatMap& flat, const BiopsyTable& table,
                  glm::ivec2 size, int finer, int threads);

/// As displayed, 0…255.
glm::u8vec3 displayed(glm::vec3 linear);

}  // namespace haustra::cad
