// One pixel of a band a thread: a slice through the CT, linearly interpolated, with window and level.
layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = 0) uniform SliceBlock { SliceUniforms u; };
layout(binding = 0) uniform sampler3D volume;
layout(rgba8, binding = 0) uniform writeonly image2D picture;

bool isInside(vec3 position) {
    return all(greaterThanEqual(position, vec3(0.0))) && all(lessThanEqual(position, vec3(1.0)));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    vec3 position = u.originTexture.xyz + float(pixel.x) * u.rightTexture.xyz + float(pixel.y + u.firstRow) * u.downTexture;
    float stored = 0.0;
    bool inside;
    if (u.samplesAside == 0) {
        stored = textureLod(volume, position, 0.0).r;
        inside = isInside(position);
    } else {
        // Of the samples along the normal that lie in the volume.
        float sum = 0.0, count = 0.0, most = 0.0;
        for (int n = -u.samplesAside; n <= u.samplesAside; ++n) {
            vec3 place = position + float(n) * u.alongTexture;
            if (!isInside(place)) continue;
            float value = textureLod(volume, place, 0.0).r;
            sum += value;
            count += 1.0;
            most = max(most, value);
        }
        inside = count > 0.0;
        if (inside) stored = u.rightTexture.w > 0.5 ? most : sum / count;
    }
    float grey = inside ? clamp(stored * u.greyScale + u.greyBias, 0.0, 1.0) : 0.0;
    if (all(lessThan(pixel, u.bandSize))) imageStore(picture, pixel, vec4(vec3(grey), 1.0));
}
