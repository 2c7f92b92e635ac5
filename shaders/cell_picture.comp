// One pixel a thread: the picture from what all cells have left of the rays.
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8, binding = 0) uniform writeonly image2D picture;
layout(rgba32f, binding = 1) uniform readonly image2D rays;

void main() {
    ivec2 pixel = ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy) + pixelOfLane(gl_LocalInvocationIndex);
    vec4 sum = finished(imageLoad(rays, pixel));
    if (all(lessThan(pixel, imageSize(picture)))) imageStore(picture, pixel, pixelColor(sum, backdropOf(pixel).rgb));
}
