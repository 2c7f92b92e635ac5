// Structs that C++ and GLSL share: std140 uniform blocks, built of 16-byte rows alone, so that
// both languages lay them out alike. GLSL reads this file as text before each shader.
#ifdef __cplusplus
#pragma once

#include <cstddef>

#include <glm/glm.hpp>

namespace haustra::shaders {
using vec4 = glm::vec4;
using ivec4 = glm::ivec4;
#endif

/// One ray-cast frame. "Texture space" spans the volume's outer faces, 0…1 along each axis.
struct MarchUniforms {
    vec4 eyeTexture;  ///< xyz: camera
    vec4 forwardMm;   ///< xyz: unit view axis in patient space
    vec4 rightMm;  ///< xyz: patient vector from the picture's centre to its right edge at depth 1
    vec4 downMm;   ///< xyz: likewise to its bottom edge
    vec4 textureRowX;    ///< rows of textureFromPatient's linear part: a patient vector (mm)
    vec4 textureRowY;    ///<   becomes a texture-space vector
    vec4 textureRowZ;    ///<
    vec4 voxelTexture;   ///< xyz: one voxel in texture space, 1 / size
    vec4 blocksPerUnit;  ///< xyz: blocks along the whole texture space, size / side; w: −½ / side
    vec4 visibleRange;   ///< x, y: a stored value strictly between may be visible; z, w: stored
                         ///< value -> table coordinate (scale, bias)
    vec4 stepping;       ///< x: stepMm, y: opacity that ends a ray, z: most steps, w: headlight
                         ///< half-distance, mm
    vec4 light;          ///< x: ambient, y: diffuse, z: specular, w: shininess
    ivec4 pictureSize;   ///< x, y: pixels, z: 1 shades
    ivec4 lastBlock;     ///< xyz: highest block index, w: pixels along a cone tile's side
};

/// One slice. Voxel coordinates, centres at integers.
struct SliceUniforms {
    vec4 originTexture;  ///< xyz: centre of the top left pixel
    vec4 rightTexture;   ///< xyz: one pixel to the right
    vec4 downTexture;    ///< xyz: one pixel down
    vec4 window;         ///< x, y: stored value -> grey 0…1 (scale, bias)
    ivec4 pictureSize;   ///< x, y: pixels
};

#ifdef __cplusplus
static_assert(sizeof(vec4) == 16 && sizeof(ivec4) == 16);
static_assert(sizeof(MarchUniforms) == 14 * 16);
static_assert(offsetof(MarchUniforms, stepping) == 10 * 16);
static_assert(offsetof(MarchUniforms, lastBlock) == 13 * 16);
static_assert(sizeof(SliceUniforms) == 5 * 16);
static_assert(offsetof(SliceUniforms, pictureSize) == 4 * 16);

/// Binding points, the same numbers in the shaders.
inline constexpr unsigned uniformBinding = 0;
inline constexpr unsigned volumeUnit = 0, leapUnit = 1, tableUnit = 2, startUnit = 3;
inline constexpr unsigned pictureImage = 0, startImage = 1;
}  // namespace haustra::shaders
#endif
