// Structs of the object-order raycaster that C++ and GLSL share; see uniforms.h.
#ifdef __cplusplus
#pragma once

#include <glm/glm.hpp>

namespace haustra::shaders {
using vec4 = glm::vec4;
using ivec4 = glm::ivec4;
#endif

/// What is the same for all cells of a frame.
struct CellUniforms {
    vec4 voxels;         ///< xyz: of the volume; w: voxels along a slot's side
    vec4 atlasPerVoxel;  ///< xyz: 1 / texels of the atlas, powers of two
    vec4 cellsPerUnit;  ///< xyz: cells along the whole texture space, voxels / side; w: −½ / side
    vec4 eye;           ///< xyz: the eye in cells; w: 1 where all rays begin there
    ivec4 lastCell;     ///< xyz: highest cell index; w: items of this dispatch
    ivec4 tiles;        ///< xy: tiles along the band
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
