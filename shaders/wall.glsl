// A raster pass over the wall: where a place of it lies in the picture.
layout(std140, binding = 2) uniform WallBlock { WallUniforms wall; };

vec4 projected(vec3 fromEyeMm) {
    float depth = dot(wall.forward, fromEyeMm);
    float w = wall.lens == orthographicLens ? 1.0 : depth;
    return vec4(dot(wall.right, fromEyeMm), wall.rowScale * dot(wall.down, fromEyeMm) + wall.rowBias * w,
                wall.depthScale * depth + wall.depthBias, w);
}
