// Which triangle of the flat map a pixel sees; those of a draw are counted from its first.
layout(location = 0) out ivec2 triangle;

void main() { triangle = ivec2(wall.firstTriangle + gl_PrimitiveID, 0); }
