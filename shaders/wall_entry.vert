// The wall, moved inwards, and what is visible before it: where rays begin to look.
layout(std430, binding = 0) readonly buffer WallVertices { vec4 places[]; };
out vec3 fromEyeMm;

void main() {
    fromEyeMm = places[gl_VertexID].xyz - wall.eyeMm;
    gl_Position = projected(fromEyeMm);
}
