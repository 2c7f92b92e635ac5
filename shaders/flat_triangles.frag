// Which triangle of the flat map covers a pixel, and in which copy of the strip.
flat in int stripCopy;
layout(location = 0) out ivec2 triangle;

void main() { triangle = ivec2(flatWindow.firstTriangle + gl_PrimitiveID, stripCopy); }
