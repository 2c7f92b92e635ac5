// One pixel of a band a thread: a slice through the CT, linearly interpolated, with window and level.
layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = 0) uniform SliceBlock { SliceUniforms u; };
layout(binding = 0) uniform sampler3D volume;
layout(rgba8, binding = 0) uniform writeonly image2D picture;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    vec3 position = u.originTexture.xyz + float(pixel.x) * u.rightTexture.xyz + float(pixel.y + u.firstRow) * u.downTexture;
    float stored = textureLod(volume, position, 0.0).r;
    bool inside = all(greaterThanEqual(position, vec3(0.0))) && all(lessThanEqual(position, vec3(1.0)));
    float grey = inside ? clamp(stored * u.greyScale + u.greyBias, 0.0, 1.0) : 0.0;
    if (all(lessThan(pixel, u.bandSize))) imageStore(picture, pixel, vec4(vec3(grey), 1.0));
}
