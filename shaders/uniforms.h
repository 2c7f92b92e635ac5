// Structs that C++ and GLSL share: std140 uniform blocks, built of 16-byte rows alone, so that
// both languages lay them out alike: a vec3 and a scalar, two pairs, or four scalars fill a row.
// GLSL reads this file as text before each shader.
#ifdef __cplusplus
#pragma once

#include <cstddef>

#include <glm/glm.hpp>

namespace haustra::shaders {
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using dvec2 = glm::dvec2;
using ivec2 = glm::ivec2;
using ivec3 = glm::ivec3;
using ivec4 = glm::ivec4;
#endif

/// One ray-cast frame. "Texture space" spans the volume's outer faces, 0…1 along each axis.
struct MarchUniforms {
    vec3 eyeTexture;  ///< camera
    float stepMm;
    vec3 forwardMm;            ///< unit view axis in patient space
    float terminationOpacity;  ///< that ends a ray
    vec3 rightMm;  ///< patient vector from the picture's centre to its right edge: at depth 1
                   ///< (perspective), as long as its angle in radians (fisheye), or the way
                   ///< itself (orthographic)
    float mostSteps;
    vec3 downMm;          ///< likewise to its bottom edge
    float lightHalvesMm;  ///< depth at which the headlight has half of its strength
    vec3 textureRowX;     ///< rows of textureFromPatient's linear part: a patient vector (mm)
    float visibleAbove;   ///< a stored value strictly between these may be visible
    vec3 textureRowY;     ///<   becomes a texture-space vector
    float visibleBelow;
    vec3 textureRowZ;
    float lastVisible;            ///< stored value from which the table goes on unchanged
    vec3 voxelTexture;            ///< one voxel in texture space, 1 / size
    float firstHitOpacity;        ///< that is a first hit
    vec3 blocksPerUnit;           ///< blocks along the whole texture space, size / side
    float firstBlock;             ///< block coordinate of texture coordinate 0: −½ / side
    float entryScale, entryBias;  ///< stored value -> table coordinate
    float rowScale, rowBias;      ///< length of a normal as gradientAt gives it -> the table's row
                                  ///<   coordinate
    float ambient, diffuse, specular, shininess;
    ivec2 pictureSize;   ///< pixels
    int lens;            ///< Lens in order
    int firstRow;        ///< of the band
    ivec3 lastBlock;     ///< highest block index
    int coneTileSide;    ///< pixels along a tile of the cone pass
    vec4 integralBelow;  ///< what the integral table grows by per entry below its first entry
    vec4 integralAbove;  ///<   and above its last
};

/// One slice, in the volume's texture coordinates.
struct SliceUniforms {
    vec4 originTexture;  ///< xyz: centre of the top left pixel
    vec4 rightTexture;   ///< xyz: one pixel to the right; w: 1 where a slab shows its maximum
    vec3 downTexture;    ///< one pixel down
    int firstRow;        ///< of the band
    ivec2 bandSize;      ///< pixels
    float greyScale, greyBias;  ///< stored value -> grey 0…1
    vec3 alongTexture;          ///< from one sample of a slab to the next
    int samplesAside;           ///< of a slab, on each side of the plane
};

/// One window onto the flattened wall. Flat coordinates are whole numbers of a small unit: what is
/// computed from them is the same to the bit in whichever picture a place is drawn. Lattice pixel g
/// covers the flat coordinates from (g + phase) to (g + 1 + phase), in pixels.
struct FlatUniforms {
    dvec2 phase;  ///< 0…1
    double unitsPerPixel, pixelsPerUnit;
    ivec2 lattice;  ///< pixel (i, j) is lattice pixel (x − 1 − i, y − 1 − j)
    int unitsPerCircumference;
    int firstCopy;      ///< of the strip, that is drawn
    ivec2 pictureSize;  ///< pixels
    int firstTriangle;  ///< that is drawn
    int lastCamera;
    float mostRayAngle;    ///< radians; between ray and the wall's normal
    float mostLightAngle;  ///<   and between light and it
    float lampAhead;       ///< how far ahead of the camera the lamp hangs, in distances to the wall
    float reachPixels;     ///< from the picture's corner to where gl_Position is 1
    float mostStepsBack;   ///< from the wall
    float riseThatEnds;    ///< of the stored value: the way back
    float mostStepsOn;     ///< from the wall
    float unused;
};

/// A vertex of the flat map; millimetres from the volume's centre, in patient directions.
struct FlatVertex {
    ivec4 flatPlace;  ///< xy: flat coordinates, in units
    vec3 placeMm;
    float camera;    ///< its index
    vec4 intoLumen;  ///< xyz: unit, from the wall inwards
};

/// A camera of the flat map.
struct FlatEye {
    vec4 placeMm;  ///< xyz: millimetres from the volume's centre
    vec4 ahead;    ///< xyz: unit, along the colon to the cecum
};

#ifdef __cplusplus
static_assert(sizeof(vec4) == 16 && sizeof(ivec4) == 16 && sizeof(dvec2) == 16);
static_assert(sizeof(vec3) == 12 && sizeof(ivec3) == 12 && sizeof(ivec2) == 8);
static_assert(sizeof(MarchUniforms) == 15 * 16);
static_assert(offsetof(MarchUniforms, mostSteps) == 2 * 16 + 12);
static_assert(offsetof(MarchUniforms, entryScale) == 9 * 16);
static_assert(offsetof(MarchUniforms, lastBlock) == 12 * 16);
static_assert(offsetof(MarchUniforms, integralAbove) == 14 * 16);
static_assert(sizeof(SliceUniforms) == 5 * 16 && offsetof(SliceUniforms, bandSize) == 3 * 16);
static_assert(sizeof(FlatUniforms) == 6 * 16 && offsetof(FlatUniforms, lattice) == 2 * 16);
static_assert(offsetof(FlatUniforms, mostRayAngle) == 4 * 16);
static_assert(sizeof(FlatVertex) == 3 * 16 && offsetof(FlatVertex, intoLumen) == 2 * 16);
static_assert(sizeof(FlatEye) == 2 * 16);

/// Binding points, the same numbers in the shaders.
inline constexpr unsigned uniformBinding = 0, flatUniformBinding = 1;
inline constexpr unsigned flatVertexBinding = 0, flatTriangleBinding = 1, flatCameraBinding = 2;
inline constexpr unsigned volumeUnit = 0, leapUnit = 1, tableUnit = 2, startUnit = 3,
                          triangleUnit = 4, integralUnit = 5, gradientUnit = 6, backdropUnit = 7;
inline constexpr unsigned pictureImage = 0, startImage = 1, gradientImage = 2;
}  // namespace haustra::shaders
#endif
