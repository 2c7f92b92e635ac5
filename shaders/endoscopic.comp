// One pixel a thread: a camera's picture.
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8, binding = 0) uniform writeonly image2D picture;
// The step from which a tile's rays must be examined.
layout(binding = 3) uniform sampler2D firstStep;

void main() {
    ivec2 pixel = tileOfGroup() * ivec2(gl_WorkGroupSize.xy) + pixelOfLane(gl_LocalInvocationIndex);
    vec2 center = vec2(pixel) + 0.5;
    Ray ray = rayThrough(center);
    vec2 inside = insideRange(ray);
    vec4 behindRay = backdropOf(pixel);
    float tileStart = texelFetch(firstStep, pixel / u.coneTileSide, 0).r;
    float end = isInPicture(center) ? floor(min(inside.y, behindRay.w / u.stepMm)) : -1.0;
    vec4 sum = march(ray, max(ceil(inside.x), tileStart), end);
    if (all(lessThan(pixel, imageSize(picture)))) imageStore(picture, pixel, pixelColor(sum, behindRay.rgb));
}
