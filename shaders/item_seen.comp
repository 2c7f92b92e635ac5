// What one picture adds to what is known of each triangle; its counts begin anew. One triangle a
// thread.
layout(local_size_x = 64) in;
layout(std140, binding = 3) uniform ItemBlock { ItemUniforms items; };
layout(std430, binding = 0) readonly buffer WallVertices { vec4 places[]; };
layout(std430, binding = 1) readonly buffer WallCorners { uint corners[]; };
layout(std430, binding = 2) buffer Observed { uint observed[]; };
layout(std430, binding = 3) buffer Total { uint total[]; };
layout(std430, binding = 4) buffer Seen { uint seen[]; };

void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint triangle = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (triangle >= uint(items.triangles)) return;
    uint sees = observed[triangle];
    if (sees == 0u) return;
    vec3 a = places[corners[3u * triangle]].xyz;
    vec3 b = places[corners[3u * triangle + 1u]].xyz;
    vec3 c = places[corners[3u * triangle + 2u]].xyz;
    // From its inner side.
    if (dot(cross(c - a, b - a), items.eyeMm - a) > 0.0)
        seen[triangle] = max(seen[triangle], items.tellFully == 1 && sees >= total[triangle] ? 2u : 1u);
    observed[triangle] = 0u;
    total[triangle] = 0u;
}
