// What march() samples: the volume, whole, in one texture. A text that stands in its place, as
// cells.glsl does, has these three too.
#ifndef GRADIENT_TEXTURE
#define GRADIENT_TEXTURE 0
#endif

// Stored value of a voxel: HU + 32768, as a 16-bit fraction.
layout(binding = 0) uniform sampler3D volume;
#if GRADIENT_TEXTURE
// Differences of the voxels' neighbours, times 32768 (gradients.comp).
layout(binding = 6) uniform sampler3D gradients;
#endif

// What a sample is: something that mayShow() and classify() take.
#define SAMPLE float

SAMPLE sampleAt(vec3 position) { return textureLod(volume, position, 0.0).r; }

// Differences over two voxels along each axis, per texture coordinate of one.
vec3 gradientAt(vec3 position) {
#if GRADIENT_TEXTURE
    // Beyond the outermost voxels' centres only one of the two values still changes.
    vec3 beyond = abs(position - 0.5) / u.voxelTexture - (0.5 / u.voxelTexture - 0.5);
    return textureLod(gradients, position, 0.0).rgb * (1.0 - clamp(beyond, 0.0, 1.0)) /
           (32768.0 * u.voxelTexture);
#else
    vec3 dx = vec3(u.voxelTexture.x, 0.0, 0.0);
    vec3 dy = vec3(0.0, u.voxelTexture.y, 0.0);
    vec3 dz = vec3(0.0, 0.0, u.voxelTexture.z);
    return vec3(sampleAt(position + dx) - sampleAt(position - dx),
                sampleAt(position + dy) - sampleAt(position - dy),
                sampleAt(position + dz) - sampleAt(position - dz)) /
           u.voxelTexture;
#endif
}
