// The ray caster: one ray through the volume, front to back (dissertation §5.1, equation 5.1).
// Every entry point that draws the volume calls march().
//
// Shape of the loops: only a loop's back edge branches on every implementation; an `if` may be
// executed under a mask and cost as much as if it were taken. So the search for something
// visible is an inner loop of few operations, and classification, gradient and shading stand
// after it.

layout(std140, binding = 0) uniform MarchBlock { MarchUniforms u; };

// Stored value of a voxel: HU + 32768, as a 16-bit fraction.
layout(binding = 0) uniform sampler3D volume;
// Per block of voxels, the Chebyshev distance in blocks to the nearest that may be visible.
layout(binding = 1) uniform usampler3D leapDistance;
// Linear colour, and opacity of one step, by stored value.
layout(binding = 2) uniform sampler1D transferTable;

struct Ray {
    vec3 origin;       // texture space, at n = 0
    vec3 step;         // texture space, one step
    vec3 directionMm;  // patient space, unit
    vec3 lightMm;      // patient space, unit: which way the light falls that lights what it meets
    float end;         // the last n inside the volume
};

vec3 textureVector(vec3 patientMm) {
    return vec3(dot(u.textureRowX.xyz, patientMm), dot(u.textureRowY.xyz, patientMm),
                dot(u.textureRowZ.xyz, patientMm));
}

// Through coordinates in the band (pixels; centres at halves). Samples lie at whole n from the eye.
Ray rayThrough(vec2 pixel) {
    vec2 ndc = 2.0 * (pixel + vec2(0.0, u.pictureSize.w)) / vec2(u.pictureSize.xy) - 1.0;
    Ray ray;
    ray.directionMm = normalize(u.forwardMm.xyz + ndc.x * u.rightMm.xyz + ndc.y * u.downMm.xyz);
    ray.lightMm = ray.directionMm;
    ray.origin = u.eyeTexture.xyz;
    ray.step = textureVector(ray.directionMm) * u.stepping.x;
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
                min(min(far.x, far.y), min(far.z, u.stepping.z)));
}

// Blocks begin at voxel centres: block b spans the centres of voxels b·side … (b + 1)·side, and
// nothing outside of these enters an interpolation inside it.
vec3 blockCoordinate(vec3 position) { return position * u.blocksPerUnit.xyz + u.blocksPerUnit.w; }

ivec3 blockAt(vec3 position) {
    return clamp(ivec3(floor(blockCoordinate(position))), ivec3(0), u.lastBlock.xyz);
}

// Steps from `position` to the first that leaves the cube of empty blocks around its block.
float stepsToLeave(vec3 position, ivec3 block, float distance, vec3 inverseBlockStep) {
    vec3 inBlock = blockCoordinate(position) - vec3(block);
    vec3 toLow = (vec3(1.0 - distance) - inBlock) * inverseBlockStep;
    vec3 toHigh = (vec3(distance) - inBlock) * inverseBlockStep;
    vec3 leave = max(toLow, toHigh);
    // A hair less, so that rounding never jumps over a sample just outside.
    return max(1.0, ceil(min(leave.x, min(leave.y, leave.z)) - 0.001));
}

// A lamp, seen from where it hangs; colours are linear light. `gradient` is per voxel index step.
vec3 shade(vec3 color, vec3 gradientTexture, Ray ray, float n) {
    // A gradient transforms by the inverse transpose of patientFromTexture.
    vec3 normal = gradientTexture.x * u.textureRowX.xyz + gradientTexture.y * u.textureRowY.xyz +
                  gradientTexture.z * u.textureRowZ.xyz;
    float slope = dot(normal, normal);
    // Light comes along the line of sight, so N·L = N·V = R·V's half angle; both faces are lit. Where
    // the volume is flat there is no surface, and nothing to shade.
    float facing = slope > 1e-20 ? abs(dot(normal, ray.lightMm)) * inversesqrt(slope) : 1.0;
    float depth = n * u.stepping.x / u.stepping.w;
    float falloff = 1.0 / (1.0 + depth * depth);
    float mirror = max(2.0 * facing * facing - 1.0, 0.0);
    float highlight = slope > 1e-20 ? u.light.z * pow(mirror, u.light.w) : 0.0;
    return falloff * (color * (u.light.x + u.light.y * facing) + highlight);
}

// Colour (linear, multiplied by opacity) and opacity along the ray from step `begin` on.
vec4 march(Ray ray, float begin, float end) {
    vec3 inverseBlockStep = 1.0 / (mix(ray.step, vec3(1e-12), equal(ray.step, vec3(0.0))) *
                                   u.blocksPerUnit.xyz);
    vec3 dx = vec3(u.voxelTexture.x, 0.0, 0.0);
    vec3 dy = vec3(0.0, u.voxelTexture.y, 0.0);
    vec3 dz = vec3(0.0, 0.0, u.voxelTexture.z);
    vec4 sum = vec4(0.0);
    float n = begin;
    while (n <= end && sum.a < u.stepping.y) {
        vec3 position;
        float stored = 0.0;
        bool searching;
        do {
            position = ray.origin + n * ray.step;
            ivec3 block = blockAt(position);
            float distance = float(texelFetch(leapDistance, block, 0).r);
            float advance = 1.0;
            searching = n <= end;
            if (distance > 0.0) {
                advance = stepsToLeave(position, block, distance, inverseBlockStep);
            } else {
                stored = textureLod(volume, position, 0.0).r;
                searching = searching && !(stored > u.visibleRange.x && stored < u.visibleRange.y);
            }
            n += searching ? advance : 0.0;
        } while (searching);
        vec4 here = textureLod(transferTable, stored * u.visibleRange.z + u.visibleRange.w, 0.0);
        vec3 gradient = vec3(textureLod(volume, position + dx, 0.0).r - textureLod(volume, position - dx, 0.0).r,
                             textureLod(volume, position + dy, 0.0).r - textureLod(volume, position - dy, 0.0).r,
                             textureLod(volume, position + dz, 0.0).r - textureLod(volume, position - dz, 0.0).r) /
                        u.voxelTexture.xyz;
        float share = n <= end ? (1.0 - sum.a) * here.a : 0.0;
        vec3 color = u.pictureSize.z == 1 ? shade(here.rgb, gradient, ray, n) : here.rgb;
        sum += vec4(share * color, share);
        n += 1.0;
    }
    return sum;
}
