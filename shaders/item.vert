// The wall's triangles from a camera's eye, the same places to the bit in both passes over them.
layout(std430, binding = 0) readonly buffer WallVertices { vec4 places[]; };
out vec3 fromEyeMm;
invariant gl_Position;

void main() {
    fromEyeMm = places[gl_VertexID].xyz - wall.eyeMm;
    gl_Position = projected(fromEyeMm);
}
