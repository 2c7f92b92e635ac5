// Structs that C++ and GLSL share: std140 uniform blocks, built of 16-byte rows alone, so that
// both languages lay them out alike. GLSL reads this file as text before each shader.
#ifdef __cplusplus
#pragma once

#include <cstddef>

#include <glm/glm.hpp>

namespace haustra::shaders {
using vec4 = glm::vec4;
using dvec2 = glm::dvec2;
using ivec4 = glm::ivec4;
#endif

/// One ray-cast frame. "Texture space" spans the volume's outer faces, 0…1 along each axis.
struct MarchUniforms {
    vec4 eyeTexture;  ///< xyz: camera
    vec4 forwardMm;   ///< xyz: unit view axis in patient space
    vec4 rightMm;  ///< xyz: patient vector from the picture's centre to its right edge: at depth 1
                   ///< (perspective), as long as its angle in radians (fisheye), or the way
                   ///< itself (orthographic)
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
    ivec4 pictureSize;  ///< x, y: pixels, z: lens (render::Lens in order), w: first row of the band
    ivec4 lastBlock;    ///< xyz: highest block index, w: pixels along a cone tile's side
    vec4 slopes;  ///< x, y: length of a normal as gradientAt gives it -> the table's row coordinate
                  ///< (scale, bias); z: stored value from which the table goes on unchanged;
                  ///< w: opacity of a first hit
    vec4 integralBelow;  ///< what the integral table grows by per entry below its first entry
    vec4 integralAbove;  ///<   and above its last
};

/// One slice. Voxel coordinates, centres at integers.
struct SliceUniforms {
    vec4 originTexture;  ///< xyz: centre of the top left pixel
    vec4 rightTexture;   ///< xyz: one pixel to the right
    vec4 downTexture;    ///< xyz: one pixel down
    vec4 window;         ///< x, y: stored value -> grey 0…1 (scale, bias)
    ivec4 pictureSize;   ///< x, y: pixels of the band, z: its first row
};

/// One window onto the flattened wall. Flat coordinates are whole numbers of a small unit: what is
/// computed from them is the same to the bit in whichever picture a place is drawn. Lattice pixel g
/// covers the flat coordinates from (g + phase) to (g + 1 + phase), in pixels.
struct FlatUniforms {
    dvec2 phase;    ///< 0…1
    dvec2 scale;    ///< x: units a pixel, y: pixels a unit
    ivec4 lattice;  ///< xy: pixel (i, j) is lattice pixel (x − 1 − i, y − 1 − j); z: units a
                    ///< circumference; w: which copy of the strip is drawn first
    ivec4 picture;  ///< xy: pixels, z: first triangle drawn, w: last camera
    vec4 angles;    ///< radians; x: most between ray and wall's normal, y: between light and it;
                    ///< z: how far ahead of the camera the lamp hangs, in distances to the wall;
                    ///< w: pixels from the picture's corner to where gl_Position is 1
    vec4 ray;       ///< x: most steps back from the wall, y: rise of the stored value that ends
                    ///< the way back, z: most steps on from the wall
};

/// A vertex of the flat map; millimetres from the volume's centre, in patient directions.
struct FlatVertex {
    ivec4 flatPlace;  ///< xy: flat coordinates, in units
    vec4 placeMm;     ///< w: index of the camera
    vec4 intoLumen;   ///< xyz: unit, from the wall inwards
};

/// A camera of the flat map.
struct FlatEye {
    vec4 placeMm;  ///< xyz: millimetres from the volume's centre
    vec4 ahead;    ///< xyz: unit, along the colon to the cecum
};

#ifdef __cplusplus
static_assert(sizeof(vec4) == 16 && sizeof(ivec4) == 16);
static_assert(sizeof(MarchUniforms) == 17 * 16);
static_assert(offsetof(MarchUniforms, stepping) == 10 * 16);
static_assert(offsetof(MarchUniforms, lastBlock) == 13 * 16);
static_assert(offsetof(MarchUniforms, integralAbove) == 16 * 16);
static_assert(sizeof(SliceUniforms) == 5 * 16);
static_assert(offsetof(SliceUniforms, pictureSize) == 4 * 16);
static_assert(sizeof(dvec2) == 16 && sizeof(FlatUniforms) == 6 * 16);
static_assert(offsetof(FlatUniforms, lattice) == 2 * 16);
static_assert(sizeof(FlatVertex) == 3 * 16 && sizeof(FlatEye) == 2 * 16);

/// Binding points, the same numbers in the shaders.
inline constexpr unsigned uniformBinding = 0, flatUniformBinding = 1;
inline constexpr unsigned flatVertexBinding = 0, flatTriangleBinding = 1, flatCameraBinding = 2;
inline constexpr unsigned volumeUnit = 0, leapUnit = 1, tableUnit = 2, startUnit = 3,
                          triangleUnit = 4, integralUnit = 5, gradientUnit = 6, backdropUnit = 7;
inline constexpr unsigned pictureImage = 0, startImage = 1, gradientImage = 2;
}  // namespace haustra::shaders
#endif
