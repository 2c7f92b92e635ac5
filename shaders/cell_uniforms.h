// Structs of the object-order raycaster that C++ and GLSL share; see uniforms.h.
#ifdef __cplusplus
#pragma once

#include "shaders/uniforms.h"

namespace haustra::shaders {
#endif

/// What is the same for all cells of a frame.
struct CellUniforms {
    vec3 voxels;           ///< of the volume
    float slotSide;        ///< voxels
    vec4 atlasPerVoxel;    ///< xyz: 1 / texels of the atlas, powers of two
    vec3 cellsPerUnit;     ///< cells along the whole texture space, voxels / side
    float firstCell;       ///< cell coordinate of texture coordinate 0: −½ / side
    vec3 eye;              ///< in cells
    float raysBeginAtEye;  ///< 1 where all rays do, else 0
    ivec3 lastCell;        ///< highest cell index
    int items;             ///< of this dispatch
    ivec4 tiles;           ///< xy: tiles along the band
};

/// A cell that is on the GPU.
struct CellInSlot {
    ivec4 cell;   ///< xyz
    vec4 corner;  ///< xyz: voxel whose value is in the slot's first texel
    vec4 slot;    ///< xyz: the slot's first texel in the atlas
};

#ifdef __cplusplus
static_assert(sizeof(CellUniforms) == 6 * 16 && sizeof(CellInSlot) == 3 * 16);

/// Binding points, the same numbers in the shaders.
inline constexpr unsigned cellUniformBinding = 3;
inline constexpr unsigned cellItemBinding = 0, cellSlotBinding = 1, liveRayBinding = 2;
inline constexpr unsigned rayImage = 1;
}  // namespace haustra::shaders
#endif
