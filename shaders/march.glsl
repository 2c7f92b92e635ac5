// The ray caster: one ray through the volume, front to back (dissertation §5.1, equation 5.1), by
// the optical model of optics.glsl. Every entry point that draws the whole volume calls march().
//
// Shape of the loops: only a loop's back edge branches on every implementation; an `if` may be
// executed under a mask and cost as much as if it were taken. So the search for something
// visible is an inner loop of few operations, and classification, gradient and shading stand
// after it.
#ifndef GRADIENT_TEXTURE
#define GRADIENT_TEXTURE 0
#endif

// Stored value of a voxel: HU + 32768, as a 16-bit fraction.
layout(binding = 0) uniform sampler3D volume;
// Per block of voxels, the Chebyshev distance in blocks to the nearest that may be visible.
layout(binding = 1) uniform usampler3D leapDistance;
#if GRADIENT_TEXTURE
// Differences of the voxels' neighbours, times 32768 (gradients.comp).
layout(binding = 6) uniform sampler3D gradients;
#endif

struct Ray {
    vec3 origin;       // texture space, at n = 0
    vec3 step;         // texture space, one step
    vec3 directionMm;  // patient space, unit
    vec3 lightMm;      // patient space, unit: which way the light falls that lights what it meets
};

vec3 textureVector(vec3 patientMm) {
    return vec3(dot(u.textureRowX.xyz, patientMm), dot(u.textureRowY.xyz, patientMm),
                dot(u.textureRowZ.xyz, patientMm));
}

const int perspectiveLens = 0, fisheyeLens = 1, orthographicLens = 2;

// From the picture's centre to a place in the band (pixels; centres at halves), see uniforms.h.
vec3 asideMm(vec2 pixel) {
    vec2 ndc = 2.0 * (pixel + vec2(0.0, u.pictureSize.w)) / vec2(u.pictureSize.xy) - 1.0;
    return ndc.x * u.rightMm.xyz + ndc.y * u.downMm.xyz;
}

// A fisheye shows nothing more than half a turn from its axis.
bool isInPicture(vec2 pixel) {
    vec3 aside = asideMm(pixel);
    return u.pictureSize.z != fisheyeLens || dot(aside, aside) <= 9.8696044;
}

// Samples lie at whole n from the eye, or from the camera's plane.
Ray rayThrough(vec2 pixel) {
    vec3 aside = asideMm(pixel);
    Ray ray;
    ray.origin = u.eyeTexture.xyz;
    if (u.pictureSize.z == perspectiveLens) {
        ray.directionMm = normalize(u.forwardMm.xyz + aside);
    } else if (u.pictureSize.z == fisheyeLens) {
        float angle = length(aside);
        ray.directionMm = normalize(cos(angle) * u.forwardMm.xyz + sin(angle) / max(angle, 1e-6) * aside);
    } else {
        ray.directionMm = u.forwardMm.xyz;
        ray.origin += textureVector(aside);
    }
    ray.lightMm = ray.directionMm;
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

// Of a ray, for stepsToLeave.
vec3 inverseBlockStepOf(Ray ray) {
    return 1.0 / (mix(ray.step, vec3(1e-12), equal(ray.step, vec3(0.0))) * u.blocksPerUnit.xyz);
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

float storedAt(vec3 position) { return textureLod(volume, position, 0.0).r; }

// Differences over two voxels along each axis, per texture coordinate of one.
vec3 gradientAt(vec3 position) {
#if GRADIENT_TEXTURE
    // Beyond the outermost voxels' centres only one of the two values still changes.
    vec3 beyond = abs(position - 0.5) / u.voxelTexture.xyz - (0.5 / u.voxelTexture.xyz - 0.5);
    return textureLod(gradients, position, 0.0).rgb * (1.0 - clamp(beyond, 0.0, 1.0)) /
           (32768.0 * u.voxelTexture.xyz);
#else
    vec3 dx = vec3(u.voxelTexture.x, 0.0, 0.0);
    vec3 dy = vec3(0.0, u.voxelTexture.y, 0.0);
    vec3 dz = vec3(0.0, 0.0, u.voxelTexture.z);
    return vec3(storedAt(position + dx) - storedAt(position - dx),
                storedAt(position + dy) - storedAt(position - dy),
                storedAt(position + dz) - storedAt(position - dz)) /
           u.voxelTexture.xyz;
#endif
}

// Goes on from step n to the first at which something may show, whose value it returns, or beyond
// `end`.
float searched(Ray ray, vec3 inverseBlockStep, inout float n, float end) {
    float stored = 0.0;
    bool searching;
    do {
        vec3 position = ray.origin + n * ray.step;
        ivec3 block = blockAt(position);
        float distance = float(texelFetch(leapDistance, block, 0).r);
        float advance = 1.0;
        searching = n <= end;
        if (distance > 0.0) {
            advance = stepsToLeave(position, block, distance, inverseBlockStep);
        } else {
            stored = storedAt(position);
            searching = searching && !mayShow(stored);
        }
        n += searching ? advance : 0.0;
    } while (searching);
    return stored;
}

// march(ray, begin, end): colour (linear, multiplied by opacity) and opacity of a ray's samples from
// step `begin` to `end`. It may begin at the ray's first step inside the volume, or anywhere in
// front of which, and at which, nothing can show. marchOn() is a part of it: it goes on from what a
// part before has left (nothing: all 0) for a ray that began at step `first`; of maximum intensity
// that is x, the greatest value, until finished() makes its colour.
#if COMPOSITION == EMISSION_ABSORPTION && !PRE_INTEGRATED
vec4 marchOn(Ray ray, vec4 sum, float first, float begin, float end) {
    vec3 inverseBlockStep = inverseBlockStepOf(ray);
    float n = begin;
    while (n <= end && sum.a < u.stepping.y) {
        float stored = searched(ray, inverseBlockStep, n, end);
#if SHADING || GRADIENT_ROWS
        vec3 normal = normalOf(gradientAt(ray.origin + n * ray.step));
#else
        vec3 normal = vec3(0.0);
#endif
        vec4 here = classify(stored, GRADIENT_ROWS == 1 ? length(normal) : 0.0);
        vec3 color = SHADING == 1 ? shade(here.rgb, normal, ray.lightMm, n) : here.rgb;
        sum = behind(sum, color, n <= end ? here.a : 0.0);
        n += 1.0;
    }
    return sum;
}
#endif

#if COMPOSITION == EMISSION_ABSORPTION && PRE_INTEGRATED
// A segment is worth a look where one of its ends lies in a block that may be visible. Others show
// nothing: blocks that touch share voxels, so that what lies in empty ones that touch is all of one
// invisible range of values, and a step of at most a voxel joins no others.
vec4 marchOn(Ray ray, vec4 sum, float first, float begin, float end) {
    vec3 inverseBlockStep = inverseBlockStepOf(ray);
    float n = begin;
    // Of the sample before n: its value, whether that is known, and whether its block may be visible,
    // as it may where another part has looked at it.
    float front = 0.0;
    bool known = false;
    bool near = begin > first;
    while (n <= end && sum.a < u.stepping.y) {
        float stored;
        bool searching;
        do {
            vec3 position = ray.origin + n * ray.step;
            ivec3 block = blockAt(position);
            float distance = float(texelFetch(leapDistance, block, 0).r);
            bool open = distance == 0.0;
            bool leaping = !(open || near);
            // Where a leap has ended, the sample before is looked at first.
            float at = known ? n : max(n - 1.0, first);
            stored = storedAt(ray.origin + at * ray.step);
            searching = n <= end && !(known && !leaping && mayShow(front, stored));
            float steps = stepsToLeave(position, block, distance, inverseBlockStep);
            float advance = leaping ? steps : known ? 1.0 : 0.0;
            n += searching ? advance : 0.0;
            front = searching ? stored : front;
            near = searching && known ? open : near;
            known = !(searching && leaping);
        } while (searching);
        vec4 here = classifySegment(front, stored);
#if SHADING
        vec3 normal = normalOf(gradientAt(ray.origin + (n - 0.5) * ray.step));
        vec3 color = shade(here.rgb, normal, ray.lightMm, n - 0.5);
#else
        vec3 color = here.rgb;
#endif
        sum = behind(sum, color, n <= end ? here.a : 0.0);
        front = stored;
        near = true;
        n += 1.0;
    }
    return sum;
}
#endif

#if COMPOSITION == MAXIMUM_INTENSITY
// The leap map lets rays leap over what lies below the first visible value.
vec4 marchOn(Ray ray, vec4 sum, float first, float begin, float end) {
    vec3 inverseBlockStep = inverseBlockStepOf(ray);
    float greatest = sum.x;
    float n = begin;
    while (n <= end && greatest < u.slopes.z) {
        vec3 position = ray.origin + n * ray.step;
        ivec3 block = blockAt(position);
        float distance = float(texelFetch(leapDistance, block, 0).r);
        greatest = max(greatest, distance > 0.0 ? 0.0 : storedAt(position));
        n += distance > 0.0 ? stepsToLeave(position, block, distance, inverseBlockStep) : 1.0;
    }
    return vec4(greatest, 0.0, 0.0, 0.0);
}
#endif

#if COMPOSITION == FIRST_HIT
const int bisections = 8;

vec4 marchOn(Ray ray, vec4 sum, float first, float begin, float end) {
    vec3 inverseBlockStep = inverseBlockStepOf(ray);
    vec4 here = vec4(0.0);
    float n = begin;
    while (n <= end && here.a < u.slopes.w) {
        float stored = searched(ray, inverseBlockStep, n, end);
        here = n <= end ? classify(stored, 0.0) : vec4(0.0);
        n += 1.0;
    }
    // The first sample has nothing before it to bisect.
    float hit = n - 1.0;
    float before = max(hit - 1.0, first);
    for (int i = 0; i < bisections; ++i) {
        float middle = 0.5 * (before + hit);
        bool beyond = classify(storedAt(ray.origin + middle * ray.step), 0.0).a >= u.slopes.w;
        hit = beyond ? middle : hit;
        before = beyond ? before : middle;
    }
    vec3 position = ray.origin + hit * ray.step;
    vec3 color = classify(storedAt(position), 0.0).rgb;
#if SHADING
    color = shade(color, normalOf(gradientAt(position)), ray.lightMm, hit);
#endif
    return here.a >= u.slopes.w ? vec4(color, 1.0) : sum;
}
#endif

// Of parts: what a ray has gathered at its end.
vec4 finished(vec4 sum) {
#if COMPOSITION == MAXIMUM_INTENSITY
    vec4 here = classify(sum.x, 0.0);
    return mayShow(sum.x) ? vec4(here.rgb * here.a, here.a) : vec4(0.0);
#else
    return sum;
#endif
}

vec4 march(Ray ray, float begin, float end) {
    return finished(marchOn(ray, vec4(0.0), begin, begin, end));
}
