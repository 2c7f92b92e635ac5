// The wall's mesh, or marks, as seen from outside.
layout(std140, binding = 0) uniform OverviewBlock { OverviewUniforms u; };
layout(std430, binding = 0) readonly buffer OverviewVertices { OverviewVertex vertices[]; };
out vec3 placeMm;
out float shownBehind;
out vec3 normal;
out vec3 color;

void main() {
    OverviewVertex vertex = vertices[gl_VertexID];
    vec4 place = vec4(vertex.placeMm, 1.0);
    gl_Position =
        vec4(dot(u.clipRowX, place), dot(u.clipRowY, place), dot(u.clipRowZ, place), dot(u.clipRowW, place));
    placeMm = vertex.placeMm;
    shownBehind = vertex.shownBehind;
    normal = vertex.normal.xyz;
    color = vertex.color.rgb;
}
