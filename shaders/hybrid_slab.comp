// Sixteen quads of rays a group: a slab of each, or, of those that were left to it, all that is
// left (dissertation §5.3.2.2, §5.3.3).
layout(local_size_x = 64) in;
// Of each pixel: the sum so far; of maximum intensity, x: the greatest value.
layout(rgba32f, binding = 1) uniform image2D rays;
// Quads to cast: x: column | row << 16, y: slabs cast before.
layout(std430, binding = 0) readonly buffer Quads {
    uint count;    // of quads
    uint samples;  // of a slab; 0: to the ray's end
    uint unused[2];
    uvec2 quads[];
};
// First and last sample of each pixel's ray, and the samples of a slab cast before.
layout(std430, binding = 1) readonly buffer Spans { vec2 spans[]; };

const float slabSamples = 32.0;

void main() {
    uint lane = gl_LocalInvocationIndex;
    uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint index = group * 16u + lane / 4u;
    if (index >= count) return;
    uvec2 quad = quads[index];
    ivec2 pixel = 2 * ivec2(quad.x & 0xffffu, quad.x >> 16) + ivec2(lane & 1u, (lane >> 1) & 1u);
    if (any(greaterThanEqual(pixel, imageSize(rays)))) return;
    vec2 span = spans[pixel.y * imageSize(rays).x + pixel.x];
    vec2 center = vec2(pixel) + 0.5;
    Ray ray = rayThrough(center);
    vec2 inside = insideRange(ray);
    float first = max(span.x, ceil(inside.x));
    float slab = span.x + float(quad.y) * slabSamples;
    float end = min(span.y, floor(min(inside.y, backdropOf(pixel).w / u.stepMm)));
    end = isInPicture(center) ? end : -1.0;
    end = samples > 0u ? min(end, slab + float(samples) - 1.0) : end;
    vec4 before = imageLoad(rays, pixel);
#if COMPOSITION == FIRST_HIT
    end = before.a > 0.0 ? -1.0 : end;
#endif
    imageStore(rays, pixel, marchOn(ray, before, first, max(first, slab), end));
}
