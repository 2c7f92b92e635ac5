// The wall: its linear colour, and how far along the ray it is.
layout(location = 0) out vec4 wall;

void main() {
    float way = clamp((dot(placeMm - u.eye, u.forward) - u.wallBegins) * u.perWallDepth, 0.0, 1.0);
    wall = vec4(mix(1.0, u.farthestShare, way) * lit(0.06), alongRay());
}
