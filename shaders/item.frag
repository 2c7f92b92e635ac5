// Which triangle a pixel sees, and how far along its ray, as a float's bits.
in vec3 fromEyeMm;
layout(location = 0) out ivec2 item;

void main() { item = ivec2(wall.firstTriangle + gl_PrimitiveID, floatBitsToInt(length(fromEyeMm))); }
