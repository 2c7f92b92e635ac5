// One pixel a thread: the flattened wall (dissertation §4.3.2).
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8, binding = 0) uniform writeonly image2D picture;
layout(binding = 4) uniform isampler2D triangleOfPixel;

// How many steps before the wall a ray starts: at the darkest sample, going back from the wall
// through the open lumen. What rises again ends the way: something stands before the wall.
// Second, the step on the ray's way to the wall from which samples may be visible.
vec2 stepsBack(vec3 wall, vec3 step) {
    float least = sampleAt(wall);
    float back = 0.0;
    float visible = 0.0;
    bool open = true;
    float before = least;
    for (float n = 1.0; open && n <= flatWindow.mostStepsBack; n += 1.0) {
        float stored = sampleAt(wall - n * step);
        open = stored < least + flatWindow.riseThatEnds;
        back = stored < least ? n : back;
        least = min(stored, least);
        visible = mayShow(before, stored) ? n : visible;
        before = stored;
    }
    // One more, where the segment to the first that is visible begins.
    return vec2(back, back - min(visible + 1.0, back));
}

void main() {
    ivec2 pixel = ivec2(gl_WorkGroupID.xy * gl_WorkGroupSize.xy) + pixelOfLane(gl_LocalInvocationIndex);
    ivec2 triangle = texelFetch(triangleOfPixel, min(pixel, u.pictureSize - 1), 0).xy;
    WallPlace wall = placeAt(pixel, triangle);
    Ray ray;
    Sight sight = sightOf(wall);
    ray.directionMm = turned(sight.ray, wall.intoLumen, flatWindow.mostRayAngle);
    ray.lightMm = turned(sight.light, wall.intoLumen, flatWindow.mostLightAngle);
    ray.step = textureVector(ray.directionMm) * u.stepMm;
    // Samples lie at whole steps from the wall's place, so that neighbouring rays meet the wall in
    // the same way.
    vec3 place = 0.5 + textureVector(wall.placeMm);
    vec2 start = stepsBack(place, ray.step);
    ray.origin = place - start.x * ray.step;
    vec2 inside = insideRange(ray);
    float end = triangle.x < 0 ? -1.0 : min(floor(inside.y), start.x + flatWindow.mostStepsOn);
    vec4 sum = march(ray, max(ceil(inside.x), start.y), end);
    if (all(lessThan(pixel, u.pictureSize))) imageStore(picture, pixel, pixelColor(sum, vec3(0.0)));
}
