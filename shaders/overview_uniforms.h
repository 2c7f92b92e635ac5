// Structs of the overview that C++ and GLSL share, laid out as those of uniforms.h. Places are
// millimetres from the overview's origin, in patient directions.
#ifdef __cplusplus
#pragma once

#include "shaders/uniforms.h"

namespace haustra::shaders {
#endif

/// How the colon is seen from outside.
struct OverviewUniforms {
    vec4 clipRowX, clipRowY, clipRowZ, clipRowW;  ///< clip coordinates of a place
    vec3 eye;                                     ///< the camera
    float raysBeginAtEye;                         ///< 1 where they do, 0 where they do at its plane
    vec3 forward;                                 ///< unit, the camera's axis
    float wallBegins;                             ///< so far before the camera
    vec3 light;                                   ///< unit, towards the lamp
    float farthestShare;                          ///< how dark the farthest wall is
    float perWallDepth;                           ///< 1 / the wall's depth
    float fadeMm;                                 ///< how far behind a wall marks fade
    float unused, unused2;
};

/// A vertex of the wall, or of a mark.
struct OverviewVertex {
    vec3 placeMm;
    float shownBehind;  ///< of a mark, what shows of it far behind a wall, 0…1
    vec4 normal;        ///< xyz: unit, outwards
    vec4 color;         ///< rgb: linear
};

#ifdef __cplusplus
static_assert(sizeof(OverviewUniforms) == 8 * 16 && sizeof(OverviewVertex) == 3 * 16);

inline constexpr unsigned overviewVertexBinding = 0;
inline constexpr unsigned overviewWallUnit = 0;
}  // namespace haustra::shaders
#endif
