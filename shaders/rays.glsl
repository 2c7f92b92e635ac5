// A camera's rays on their way through the volume, and the empty blocks that they leap over.

// Per block of voxels, the Chebyshev distance in blocks to the nearest that may be visible.
layout(binding = 1) uniform usampler3D leapDistance;

struct Ray {
    vec3 origin;       // texture space, at n = 0
    vec3 step;         // texture space, one step
    vec3 directionMm;  // patient space, unit
    vec3 lightMm;      // patient space, unit: which way the light falls that lights what it meets
};

vec3 textureVector(vec3 patientMm) {
    return vec3(dot(u.textureRowX, patientMm), dot(u.textureRowY, patientMm), dot(u.textureRowZ, patientMm));
}

// From the picture's centre to a place in the band (pixels; centres at halves), see uniforms.h.
vec3 asideMm(vec2 pixel) {
    vec2 place = placeInPicture(pixel, u.firstRow, u.pictureSize);
    return place.x * u.rightMm + place.y * u.downMm;
}

bool isInPicture(vec2 pixel) { return isShown(u.lens, asideMm(pixel)); }

// Samples lie at whole n from the eye, or from the camera's plane.
Ray rayThrough(vec2 pixel) {
    LensRay through = lensRay(u.lens, u.forwardMm, asideMm(pixel));
    Ray ray;
    ray.origin = u.eyeTexture + textureVector(through.fromEye);
    ray.directionMm = through.direction;
    ray.lightMm = ray.directionMm;
    ray.step = textureVector(ray.directionMm) * u.stepMm;
    return ray;
}

// The range of n in which a ray is inside the volume.
vec2 insideRange(Ray ray) {
    vec3 inverse = 1.0 / mix(ray.step, vec3(1e-12), equal(ray.step, vec3(0.0)));
    vec3 a = (vec3(0.0) - ray.origin) * inverse;
    vec3 b = (vec3(1.0) - ray.origin) * inverse;
    vec3 near = min(a, b);
    vec3 far = max(a, b);
    return vec2(max(max(near.x, near.y), max(near.z, 0.0)),
                min(min(far.x, far.y), min(far.z, u.mostSteps)));
}

// Blocks begin at voxel centres: block b spans the centres of voxels b·side … (b + 1)·side, and
// nothing outside of these enters an interpolation inside it.
//
// What a ray asks of them at every step. Of uniforms these are copies: where a loop names a uniform, a
// software device reads and checks it again in each turn.
struct Blocks {
    vec3 perUnit;
    float first;
    ivec3 last;
    vec3 inverseStep;  // of the ray, in blocks
};

Blocks blocksOf(Ray ray) {
    vec3 step = mix(ray.step, vec3(1e-12), equal(ray.step, vec3(0.0)));
    return Blocks(u.blocksPerUnit, u.firstBlock, u.lastBlock, 1.0 / (step * u.blocksPerUnit));
}

vec3 blockCoordinate(Blocks blocks, vec3 position) { return position * blocks.perUnit + blocks.first; }

ivec3 blockAt(Blocks blocks, vec3 position) {
    return clamp(ivec3(floor(blockCoordinate(blocks, position))), ivec3(0), blocks.last);
}

// Steps from `position` to the first that leaves the cube of empty blocks around its block.
float stepsToLeave(Blocks blocks, vec3 position, ivec3 block, float distance) {
    vec3 inBlock = blockCoordinate(blocks, position) - vec3(block);
    vec3 toLow = (vec3(1.0 - distance) - inBlock) * blocks.inverseStep;
    vec3 toHigh = (vec3(distance) - inBlock) * blocks.inverseStep;
    vec3 leave = max(toLow, toHigh);
    // A hair less, so that rounding never jumps over a sample just outside.
    return max(1.0, ceil(min(leave.x, min(leave.y, leave.z)) - 0.001));
}
