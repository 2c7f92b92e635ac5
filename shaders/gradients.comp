// One column of voxels a thread: what gradientAt of march.glsl reads (dissertation §5.3.2.2, §7.2.2).
// Between voxels, interpolated differences are the differences of interpolated values.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler3D volume;
layout(rgba16f, binding = 2) uniform writeonly image3D gradients;

float storedAt(ivec3 voxel) { return texelFetch(volume, voxel, 0).r; }

void main() {
    ivec3 last = textureSize(volume, 0) - 1;
    ivec3 voxel = ivec3(gl_GlobalInvocationID.xy, 0);
    bool inside = all(lessThanEqual(voxel.xy, last.xy));
    voxel.xy = min(voxel.xy, last.xy);
    for (; inside && voxel.z <= last.z; ++voxel.z) {
        ivec3 low = max(voxel - 1, ivec3(0));
        ivec3 high = min(voxel + 1, last);
        vec3 differences =
            vec3(storedAt(ivec3(high.x, voxel.yz)) - storedAt(ivec3(low.x, voxel.yz)),
                 storedAt(ivec3(voxel.x, high.y, voxel.z)) - storedAt(ivec3(voxel.x, low.y, voxel.z)),
                 storedAt(ivec3(voxel.xy, high.z)) - storedAt(ivec3(voxel.xy, low.z)));
        // Half floats hold differences of up to 2048 HU exactly.
        imageStore(gradients, voxel, vec4(differences * 32768.0, 0.0));
    }
}
