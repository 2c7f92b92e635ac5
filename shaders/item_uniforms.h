// What the passes of an item buffer are told beside their raster's WallUniforms; laid out as those
// of uniforms.h.
#ifdef __cplusplus
#pragma once

#include "shaders/uniforms.h"

namespace haustra::shaders {
#endif

struct ItemUniforms {
    vec3 eyeMm;       ///< from the wall's origin
    float nearestMm;  ///< the depth of field, along rays
    float farthestMm;
    int triangles;
    int tellFully;  ///< 1: partly from fully seen triangles
    int unused;
};

#ifdef __cplusplus
static_assert(sizeof(ItemUniforms) == 2 * 16);

inline constexpr unsigned itemUniformBinding = 3;
inline constexpr unsigned itemVertexBinding = 0, itemCornerBinding = 1, itemObservedBinding = 2,
                          itemTotalBinding = 3, itemSeenBinding = 4;
inline constexpr unsigned itemUnit = 4;
}  // namespace haustra::shaders
#endif
