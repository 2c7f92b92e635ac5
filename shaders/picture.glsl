// What the entry points that cast a ray for each pixel share.
#ifndef BACKDROP
#define BACKDROP 0
#endif
#if BACKDROP
// Linear colour, and the millimetres at which a ray ends; rows as in the picture.
layout(binding = 7) uniform sampler2D backdrop;
#endif

// Eight neighbouring lanes, a vector unit's width in software, take four pixels by two: rays that
// stay together share their loops.
ivec2 pixelOfLane(uint lane) {
    return ivec2((lane & 3u) | ((lane >> 1) & 4u), ((lane >> 2) & 1u) | ((lane >> 3) & 6u));
}

// The n-th of `count` things in the order in which they are dealt to work groups. A software device
// gives each of its threads one run of successive groups, whatever they cost: when every eighth
// comes first, each run has some from all over, and the threads end together.
int dealt(int n, int count) {
    const int hands = 8;
    int each = count / hands, longer = count % hands;
    int later = n - longer * (each + 1);
    return later < 0 ? hands * (n % (each + 1)) + n / (each + 1)
                     : hands * (later % each) + longer + later / each;
}

// The tile of pixels that this work group draws.
ivec2 tileOfGroup() {
    return ivec2(int(gl_WorkGroupID.x), dealt(int(gl_WorkGroupID.y), int(gl_NumWorkGroups.y)));
}

// What lies behind a pixel of the band.
vec4 backdropOf(ivec2 pixel) {
#if BACKDROP
    return texelFetch(backdrop, pixel + ivec2(0, u.firstRow), 0);
#else
    return vec4(0.0, 0.0, 0.0, 1e30);
#endif
}
