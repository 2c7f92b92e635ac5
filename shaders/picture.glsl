// What the entry points that cast a ray for each pixel share.
// sRGB's transfer curve (IEC 61966-2-1).
vec3 displayed(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

// Eight neighbouring lanes, a vector unit's width in software, take four pixels by two: rays that
// stay together share their loops.
ivec2 pixelOfLane(uint lane) {
    return ivec2((lane & 3u) | ((lane >> 1) & 4u), ((lane >> 2) & 1u) | ((lane >> 3) & 6u));
}

// The displayed colour of a ray's sum, over black.
vec4 pixelColor(vec4 sum) {
    // A ray that was ended early counts as opaque, or its pixel would be darker than its neighbours.
    vec3 color = sum.a >= u.stepping.y ? sum.rgb / sum.a : sum.rgb;
    return vec4(displayed(color), 1.0);
}
