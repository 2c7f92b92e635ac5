// N_observed: the pixels that see each triangle within the depth of field. One pixel a thread.
layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = 3) uniform ItemBlock { ItemUniforms items; };
layout(binding = 4) uniform isampler2D itemOfPixel;
layout(std430, binding = 2) buffer Observed { uint observed[]; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, textureSize(itemOfPixel, 0)))) return;
    ivec2 item = texelFetch(itemOfPixel, pixel, 0).xy;
    float depthMm = intBitsToFloat(item.y);
    if (item.x >= 0 && depthMm >= items.nearestMm && depthMm <= items.farthestMm)
        atomicAdd(observed[item.x], 1u);
}
