// The last step of a ray that certainly lies before what the pixel sees.
in vec3 fromEyeMm;
layout(location = 0) out float firstStep;

void main() {
    float depthMm = wall.lens == orthographicLens ? dot(wall.forward, fromEyeMm) : length(fromEyeMm);
    firstStep = max(floor(depthMm * wall.stepsPerMm) - 1.0, 0.0);
}
