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
    vec4 eye;      ///< xyz: the camera; w: 1 where rays start at it, 0 at its plane
    vec4 forward;  ///< xyz: unit, the camera's axis
    vec4 light;    ///< xyz: unit, towards the lamp; w: how dark the farthest wall is
    vec4 depth;    ///< x: where the wall begins before the camera, y: 1 / its depth; z: how far
                   ///< behind a wall marks fade
};

/// A vertex of the wall, or of a mark.
struct OverviewVertex {
    vec4 placeMm;  ///< w: of a mark, what shows of it far behind a wall, 0…1
    vec4 normal;   ///< xyz: unit, outwards
    vec4 color;    ///< rgb: linear
};

#ifdef __cplusplus
static_assert(sizeof(OverviewUniforms) == 8 * 16 && sizeof(OverviewVertex) == 3 * 16);

inline constexpr unsigned overviewVertexBinding = 0;
inline constexpr unsigned overviewWallUnit = 0;
}  // namespace haustra::shaders
#endif
