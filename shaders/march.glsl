// The ray caster: one ray through the volume, front to back (dissertation §5.1, equation 5.1), by
// the optical model of optics.glsl. Every entry point that casts rays calls march() or marchOn(); what
// they sample stands before this text: the whole volume (volume.glsl) or one cell (cells.glsl).
//
// Shape of the loops: only a loop's back edge branches on every implementation; an `if` may be
// executed under a mask and cost as much as if it were taken. So the search for something
// visible is an inner loop of few operations, and classification, gradient and shading stand
// after it.

// Goes on from step n to the first at which something may show, whose value it returns, or beyond
// `end`.
SAMPLE searched(Ray ray, Blocks blocks, inout float n, float end) {
    SAMPLE stored = SAMPLE(0.0);
    bool searching;
    do {
        vec3 position = ray.origin + n * ray.step;
        ivec3 block = blockAt(blocks, position);
        float distance = float(texelFetch(leapDistance, block, 0).r);
        float advance = 1.0;
        searching = n <= end;
        if (distance > 0.0) {
            advance = stepsToLeave(blocks, position, block, distance);
        } else {
            stored = sampleAt(position);
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
    Blocks blocks = blocksOf(ray);
    float n = begin;
    while (n <= end && sum.a < u.terminationOpacity) {
        SAMPLE stored = searched(ray, blocks, n, end);
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
    Blocks blocks = blocksOf(ray);
    float n = begin;
    // Of the sample before n: its value, whether that is known, and whether its block may be visible,
    // as it may where another part has looked at it.
    float front = 0.0;
    bool known = false;
    bool near = begin > first;
    while (n <= end && sum.a < u.terminationOpacity) {
        float stored;
        bool searching;
        do {
            vec3 position = ray.origin + n * ray.step;
            ivec3 block = blockAt(blocks, position);
            float distance = float(texelFetch(leapDistance, block, 0).r);
            bool open = distance == 0.0;
            bool leaping = !(open || near);
            // Where a leap has ended, the sample before is looked at first.
            float at = known ? n : max(n - 1.0, first);
            stored = sampleAt(ray.origin + at * ray.step);
            searching = n <= end && !(known && !leaping && mayShow(front, stored));
            float steps = stepsToLeave(blocks, position, block, distance);
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
    Blocks blocks = blocksOf(ray);
    float greatest = sum.x;
    float n = begin;
    while (n <= end && greatest < u.lastVisible) {
        vec3 position = ray.origin + n * ray.step;
        ivec3 block = blockAt(blocks, position);
        float distance = float(texelFetch(leapDistance, block, 0).r);
        greatest = max(greatest, distance > 0.0 ? 0.0 : sampleAt(position));
        n += distance > 0.0 ? stepsToLeave(blocks, position, block, distance) : 1.0;
    }
    return vec4(greatest, 0.0, 0.0, 0.0);
}
#endif

#if COMPOSITION == FIRST_HIT
const int bisections = 8;

vec4 marchOn(Ray ray, vec4 sum, float first, float begin, float end) {
    Blocks blocks = blocksOf(ray);
    vec4 here = vec4(0.0);
    float n = begin;
    while (n <= end && here.a < u.firstHitOpacity) {
        SAMPLE stored = searched(ray, blocks, n, end);
        here = n <= end ? classify(stored, 0.0) : vec4(0.0);
        n += 1.0;
    }
    // Loops that are not entered where nothing is hit: only they branch everywhere. The first sample
    // has nothing before it to bisect.
    float hit = n - 1.0;
    float before = max(hit - 1.0, first);
    int rounds = here.a >= u.firstHitOpacity ? bisections : 0;
    for (int i = 0; i < rounds; ++i) {
        float middle = 0.5 * (before + hit);
        bool beyond = classify(sampleAt(ray.origin + middle * ray.step), 0.0).a >= u.firstHitOpacity;
        hit = beyond ? middle : hit;
        before = beyond ? before : middle;
    }
    for (int i = 0; i < min(rounds, 1); ++i) {
        vec3 position = ray.origin + hit * ray.step;
        vec3 color = classify(sampleAt(position), 0.0).rgb;
#if SHADING
        color = shade(color, normalOf(gradientAt(position)), ray.lightMm, hit);
#endif
        sum = vec4(color, 1.0);
    }
    return sum;
}
#endif

vec4 march(Ray ray, float begin, float end) {
    return finished(marchOn(ray, vec4(0.0), begin, begin, end));
}
