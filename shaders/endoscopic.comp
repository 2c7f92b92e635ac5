// One pixel a thread: the endoscopic picture.
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8, binding = 0) uniform writeonly image2D picture;
// The step from which a tile's rays must be examined.
layout(binding = 3) uniform sampler2D firstStep;

void main() {
    ivec2 pixel = ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy) + pixelOfLane(gl_LocalInvocationIndex);
    Ray ray = rayThrough(vec2(pixel) + 0.5);
    vec2 inside = insideRange(ray);
    float tileStart = texelFetch(firstStep, pixel / u.lastBlock.w, 0).r;
    vec4 sum = march(ray, max(ceil(inside.x), tileStart), floor(inside.y));
    if (all(lessThan(pixel, imageSize(picture)))) imageStore(picture, pixel, pixelColor(sum));
}
