// The wall: its linear colour, and how far along the ray it is.
layout(location = 0) out vec4 wall;

void main() {
    float way = clamp((dot(placeMm.xyz - u.eye.xyz, u.forward.xyz) - u.depth.x) * u.depth.y, 0.0, 1.0);
    wall = vec4(mix(1.0, u.light.w, way) * lit(0.06), alongRay());
}
