// The flat map's triangles, once for each copy of the strip that the picture shows.
flat out int stripCopy;

void main() {
    stripCopy = flatWindow.firstCopy + gl_InstanceID;
    dvec2 place = dvec2(flatVertices[gl_VertexID].flatPlace.xy) +
                  dvec2(double(stripCopy) * double(flatWindow.unitsPerCircumference), 0.0);
    // Snapped to the lattice before the picture's own place enters: which triangle covers a pixel
    // does not depend on the picture that the pixel is in. Rasterizers snap as finely or coarser.
    dvec2 snapped = floor((place * flatWindow.pixelsPerUnit - flatWindow.phase) * 256.0 + 0.5);
    vec2 pixel = vec2(dvec2(flatWindow.lattice) * 256.0 - snapped) / 256.0;
    gl_Position = vec4(pixel / flatWindow.reachPixels, 0.0, 1.0);
}
