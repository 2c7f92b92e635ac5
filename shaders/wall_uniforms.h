// What raster passes over the wall are told; std140, as in uniforms.h, which must stand before it.
#ifdef __cplusplus
#pragma once

#include "shaders/uniforms.h"

namespace haustra::shaders {
#endif

/// A raster pass over the wall, from a camera's eye or through one side of a cube around it.
/// Millimetres are counted from the volume's centre, in patient directions.
struct WallUniforms {
    vec3 eyeMm;
    float depthScale;  ///< gl_Position.z = depth · depthScale + depthBias
    vec3 forward;      ///< unit
    float depthBias;
    vec3 right;                   ///< gl_Position.x of a vector from the eye
    int isCubeSide;               ///< 1 where the pass is one
    vec3 down;                    ///< likewise y, in the whole picture
    int lens;                     ///< Lens in order
    vec3 lensRight;               ///< to the picture's right edge, as rightMm of MarchUniforms
    float unitsPerCircumference;  ///< of flat coordinates
    vec3 lensDown;                ///< likewise to its bottom edge
    float stepsPerMm;
    vec3 lensAhead;           ///< unit, the camera's own forward
    int firstTriangle;        ///< of the draw
    float rowScale, rowBias;  ///< gl_Position.y in the band = y · rowScale + w · rowBias
    ivec2 unused;
    ivec2 pictureSize;  ///< pixels of the whole picture
    int firstRow;       ///< of the band
    int unused2;
};

#ifdef __cplusplus
static_assert(sizeof(WallUniforms) == 9 * 16);

inline constexpr unsigned wallUniformBinding = 2;
inline constexpr unsigned wallVertexBinding = 0;
}  // namespace haustra::shaders
#endif
