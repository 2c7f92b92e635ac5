// A raster pass over the wall: where a place of it lies in the picture.
layout(std140, binding = 2) uniform WallBlock { WallUniforms wall; };

vec4 projected(vec3 fromEyeMm) {
    float depth = dot(wall.forward.xyz, fromEyeMm);
    float w = wall.eyeMm.w == 1.0 ? 1.0 : depth;
    return vec4(dot(wall.right.xyz, fromEyeMm), wall.rows.x * dot(wall.down.xyz, fromEyeMm) + wall.rows.y * w,
                wall.forward.w * depth + wall.right.w, w);
}
