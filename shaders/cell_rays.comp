// One tile of pixels and one cell a group: the part of the tile's rays that is in the cell
// (dissertation §5.2.1, its four passes in one).
layout(local_size_x = 8, local_size_y = 8) in;
// Of each pixel: the sum so far; of maximum intensity, x: the greatest value.
layout(rgba32f, binding = 1) uniform image2D rays;
// x: tile, column | row << 16; y: cell.
layout(std430, binding = 0) readonly buffer CellItems { uvec2 items[]; };
layout(std430, binding = 1) readonly buffer CellSlots { CellInSlot inSlots[]; };
// Rays of each tile that have not ended; the CPU leaves out tiles that have none.
layout(std430, binding = 2) coherent buffer LiveRays { int liveRays[]; };

bool isLive(vec4 sum) {
#if COMPOSITION == MAXIMUM_INTENSITY
    return sum.x < u.slopes.z;
#else
    return sum.a < u.stepping.y;
#endif
}

// As march(), from `begin` to `end` alone; `first` is the ray's first sample in the volume, where
// nothing is before it.
#if COLOR_CELLS
// Voxels have colours of their own, as displayed, and opacity for 1 mm.
vec3 linearOf(vec3 displayed) {
    vec3 c = clamp(displayed, 0.0, 1.0);
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

vec4 marchCell(CellInSlot cell, Ray ray, vec4 sum, float first, float begin, float end) {
    vec3 inverseBlockStep = inverseBlockStepOf(ray);
    float n = begin;
    while (n <= end && sum.a < u.stepping.y) {
        vec3 position;
        vec4 texel = vec4(0.0);
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
                texel = texelInSlot(inSlot(position, cell), cell);
                searching = searching && !(texel.a > 0.0);
            }
            n += searching ? advance : 0.0;
        } while (searching);
        vec3 color = linearOf(texel.rgb);
#if SHADING
        color = shade(color, normalOf(gradientIn(cell, position)), ray.lightMm, n);
#endif
        float opacity = 1.0 - pow(max(1.0 - texel.a, 0.0), u.stepping.x);
        sum = behind(sum, color, n <= end ? opacity : 0.0);
        n += 1.0;
    }
    return sum;
}
#elif COMPOSITION == EMISSION_ABSORPTION && !PRE_INTEGRATED
vec4 marchCell(CellInSlot cell, Ray ray, vec4 sum, float first, float begin, float end) {
    vec3 inverseBlockStep = inverseBlockStepOf(ray);
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
                stored = storedIn(cell, position);
                searching = searching && !mayShow(stored);
            }
            n += searching ? advance : 0.0;
        } while (searching);
#if SHADING || GRADIENT_ROWS
        vec3 normal = normalOf(gradientIn(cell, position));
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
vec4 marchCell(CellInSlot cell, Ray ray, vec4 sum, float first, float begin, float end) {
    vec3 inverseBlockStep = inverseBlockStepOf(ray);
    float n = begin;
    // The segment to the first sample begins in the cell before, as far as the border reaches.
    vec3 before = ray.origin + max(n - 1.0, first) * ray.step;
    float front = storedIn(cell, before);
    float frontDistance = float(texelFetch(leapDistance, blockAt(before), 0).r);
    while (n <= end && sum.a < u.stepping.y) {
        float stored;
        float distance;
        bool searching;
        do {
            vec3 position = ray.origin + n * ray.step;
            ivec3 block = blockAt(position);
            distance = float(texelFetch(leapDistance, block, 0).r);
            stored = storedIn(cell, position);
            searching = n <= end && !(min(distance, frontDistance) == 0.0 && mayShow(front, stored));
            float advance = distance > 0.0
                ? max(stepsToLeave(position, block, distance, inverseBlockStep) - 1.0, 1.0)
                : 1.0;
            n += searching ? advance : 0.0;
            front = searching ? stored : front;
            frontDistance = searching ? distance : frontDistance;
        } while (searching);
        vec4 here = classifySegment(front, stored);
#if SHADING
        vec3 normal = normalOf(gradientIn(cell, ray.origin + (n - 0.5) * ray.step));
        vec3 color = shade(here.rgb, normal, ray.lightMm, n - 0.5);
#else
        vec3 color = here.rgb;
#endif
        sum = behind(sum, color, n <= end ? here.a : 0.0);
        front = stored;
        frontDistance = distance;
        n += 1.0;
    }
    return sum;
}
#endif

#if COMPOSITION == MAXIMUM_INTENSITY
vec4 marchCell(CellInSlot cell, Ray ray, vec4 sum, float first, float begin, float end) {
    vec3 inverseBlockStep = inverseBlockStepOf(ray);
    float greatest = sum.x;
    float n = begin;
    while (n <= end && greatest < u.slopes.z) {
        vec3 position = ray.origin + n * ray.step;
        ivec3 block = blockAt(position);
        float distance = float(texelFetch(leapDistance, block, 0).r);
        greatest = max(greatest, distance > 0.0 ? 0.0 : storedIn(cell, position));
        n += distance > 0.0 ? stepsToLeave(position, block, distance, inverseBlockStep) : 1.0;
    }
    return vec4(greatest, 0.0, 0.0, 0.0);
}
#endif

#if COMPOSITION == FIRST_HIT
vec4 marchCell(CellInSlot cell, Ray ray, vec4 sum, float first, float begin, float end) {
    vec3 inverseBlockStep = inverseBlockStepOf(ray);
    vec4 here = vec4(0.0);
    float n = begin;
    while (n <= end && here.a < u.slopes.w) {
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
                stored = storedIn(cell, position);
                searching = searching && !mayShow(stored);
            }
            n += searching ? advance : 0.0;
        } while (searching);
        here = n <= end ? classify(stored, 0.0) : vec4(0.0);
        n += 1.0;
    }
    // Loops that are not entered where nothing is hit: only they branch everywhere.
    float hit = n - 1.0;
    float before = max(hit - 1.0, first);
    int rounds = here.a >= u.slopes.w ? bisections : 0;
    for (int i = 0; i < rounds; ++i) {
        float middle = 0.5 * (before + hit);
        bool beyond = classify(storedIn(cell, ray.origin + middle * ray.step), 0.0).a >= u.slopes.w;
        hit = beyond ? middle : hit;
        before = beyond ? before : middle;
    }
    for (int i = 0; i < min(rounds, 1); ++i) {
        vec3 position = ray.origin + hit * ray.step;
        vec3 color = classify(storedIn(cell, position), 0.0).rgb;
#if SHADING
        color = shade(color, normalOf(gradientIn(cell, position)), ray.lightMm, hit);
#endif
        sum = vec4(color, 1.0);
    }
    return sum;
}
#endif

void main() {
    uint item = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (item >= uint(cells.lastCell.w)) return;
    ivec2 tile = ivec2(items[item].x & 0xffffu, items[item].x >> 16);
    int tileIndex = tile.x + tile.y * cells.tiles.x;
    if (liveRays[tileIndex] == 0) return;
    CellInSlot cell = inSlots[items[item].y];
    ivec2 pixel = tile * ivec2(gl_WorkGroupSize.xy) + pixelOfLane(gl_LocalInvocationIndex);
    vec2 center = vec2(pixel) + 0.5;
    Ray ray = rayThrough(center);
    vec2 inside = insideRange(ray);
    vec2 samples = samplesInCell(ray, cell.cell.xyz);
    float first = ceil(inside.x);
    float begin = max(first, samples.x);
    float end = min(floor(min(inside.y, backdropOf(pixel).w / u.stepping.x)), samples.y - 1.0);
    bool drawn = all(lessThan(pixel, imageSize(rays))) && isInPicture(center);
    vec4 before = imageLoad(rays, pixel);
    end = drawn && isLive(before) ? end : -1.0;
    vec4 after = marchCell(cell, ray, before, first, begin, end);
    // Rays outside of the cell leave their pixel to another cell of the layer.
    if (begin <= end) {
        imageStore(rays, pixel, after);
        if (!isLive(after)) atomicAdd(liveRays[tileIndex], -1);
    }
}
