// How a camera projects the wall's triangles.
#pragma once

#include "render/scene/picture.h"
#include "render/scene/raycaster.h"
#include "shaders/wall_uniforms.h"

namespace haustra::render {

/// The raster pass of a band as a perspective or orthographic camera sees it: pixel by pixel the
/// rays of the raycasters. Millimetres of vertices are counted from `originMm`. Nothing nearer than
/// a tenth of a millimetre is drawn, nor beyond 10 m.
shaders::WallUniforms wallProjection(const Camera& camera, const Band& band, glm::dvec3 originMm);

/// One side of a cube around the camera, for lenses that bend straight lines: 0…5, the first ahead
/// and the last behind. The lens's fields are the camera's own.
shaders::WallUniforms cubeSide(const Camera& camera, const Band& band, glm::dvec3 originMm,
                               int side);

/// False only where a ball, `middle` of it given from the eye, shows nothing in a pass.
bool mayShow(const shaders::WallUniforms& pass, glm::vec3 middle, float radius);

}  // namespace haustra::render
