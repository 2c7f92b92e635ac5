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

// What lies behind a pixel of the band.
vec4 backdropOf(ivec2 pixel) {
#if BACKDROP
    return texelFetch(backdrop, pixel + ivec2(0, u.pictureSize.w), 0);
#else
    return vec4(0.0, 0.0, 0.0, 1e30);
#endif
}
