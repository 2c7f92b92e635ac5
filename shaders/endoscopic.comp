// One pixel a thread: the endoscopic picture.
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8, binding = 0) uniform writeonly image2D picture;
// The step from which a tile's rays must be examined.
layout(binding = 3) uniform sampler2D firstStep;

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

void main() {
    ivec2 pixel = ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy) + pixelOfLane(gl_LocalInvocationIndex);
    Ray ray = rayThrough(vec2(pixel) + 0.5);
    vec2 inside = insideRange(ray);
    float tileStart = texelFetch(firstStep, pixel / u.lastBlock.w, 0).r;
    vec4 sum = march(ray, max(ceil(inside.x), tileStart), floor(inside.y));
    // A ray that was ended early counts as opaque, or its pixel would be darker than its neighbours.
    vec3 color = sum.a >= u.stepping.y ? sum.rgb / sum.a : sum.rgb;
    if (all(lessThan(pixel, u.pictureSize.xy))) imageStore(picture, pixel, vec4(displayed(color), 1.0));
}
