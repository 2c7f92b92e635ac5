// The last step of a ray that certainly lies before what the pixel sees.
in vec3 fromEyeMm;
layout(location = 0) out float firstStep;

void main() {
    float depthMm = wall.eyeMm.w == 1.0 ? dot(wall.forward.xyz, fromEyeMm) : length(fromEyeMm);
    firstStep = max(floor(depthMm * wall.lensDown.w) - 1.0, 0.0);
}
