// What raster passes over the wall are told; std140, as in uniforms.h, which must stand before it.
#ifdef __cplusplus
#pragma once

#include "shaders/uniforms.h"

namespace haustra::shaders {
#endif

/// A raster pass over the wall, from a camera's eye or through one side of a cube around it.
/// Millimetres are counted from the volume's centre, in patient directions.
struct WallUniforms {
    vec4 eyeMm;      ///< xyz; w: 1 where rays are parallel, 0 where they come from the eye
    vec4 forward;    ///< xyz: unit; w: gl_Position.z = depth · w + right.w
    vec4 right;      ///< xyz: gl_Position.x of a vector from the eye
    vec4 down;       ///< xyz: likewise y, in the whole picture; w: a fisheye's half angle, else 0
    vec4 lensRight;  ///< xyz: to the picture's right edge: of a direction at depth 1, of a fisheye
                     ///< in half heights, of an orthographic camera in mm; w: units of flat
                     ///< coordinates a circumference
    vec4 lensDown;   ///< xyz: likewise to its bottom edge; w: steps a mm
    vec4 lensAhead;  ///< xyz: unit, the camera's own forward; w: the first triangle of the draw
    vec4 rows;       ///< x, y: gl_Position.y in the band = y · x + w · y
    ivec4 picture;   ///< x, y: pixels of the whole picture, z: first row of the band, w: 1 where
                     ///< the pass is a cube's side
};

#ifdef __cplusplus
static_assert(sizeof(WallUniforms) == 9 * 16);

inline constexpr unsigned wallUniformBinding = 2;
inline constexpr unsigned wallVertexBinding = 0;
}  // namespace haustra::shaders
#endif
