// Which triangle of the flat map a pixel sees.
layout(location = 0) out ivec2 triangle;

void main() { triangle = ivec2(gl_PrimitiveID, 0); }
