// One pixel a thread: the flattened wall (dissertation §4.3.2).
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8, binding = 0) uniform writeonly image2D picture;
layout(binding = 4) uniform isampler2D triangleOfPixel;
layout(std430, binding = 1) readonly buffer FlatTriangles { uint corners[]; };
layout(std430, binding = 2) readonly buffer FlatCameras { FlatEye cameras[]; };

// A place of the wall as the flat map has it; millimetres from the volume's centre.
struct WallPlace {
    vec3 placeMm;
    vec3 intoLumen;  // unit
    float camera;    // index into cameras, a fraction between two
};

float turn(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// The place that a pixel shows, by its barycentric coordinates in the triangle that covers it.
WallPlace placeAt(ivec2 pixel, ivec2 triangle) {
    dvec2 latticePixel = dvec2(flatWindow.lattice.xy - 1 - pixel) + 0.5 + flatWindow.phase;
    ivec2 here = ivec2(floor(latticePixel * flatWindow.scale.x + 0.5));
    here.x -= triangle.y * flatWindow.lattice.z;
    uint first = 3u * uint(max(triangle.x, 0));
    FlatVertex a = flatVertices[corners[first]];
    FlatVertex b = flatVertices[corners[first + 1u]];
    FlatVertex c = flatVertices[corners[first + 2u]];
    vec2 toA = vec2(a.flatPlace.xy - here);
    vec2 toB = vec2(b.flatPlace.xy - here);
    vec2 toC = vec2(c.flatPlace.xy - here);
    // A pixel may lie a hair outside of the triangle that was found to cover it.
    vec3 weights = max(vec3(turn(toB, toC), turn(toC, toA), turn(toA, toB)), 0.0);
    float sum = weights.x + weights.y + weights.z;
    weights = sum > 0.0 ? weights / sum : vec3(1.0 / 3.0);
    vec4 place = weights.x * a.placeMm + weights.y * b.placeMm + weights.z * c.placeMm;
    vec3 inwards = weights.x * a.intoLumen.xyz + weights.y * b.intoLumen.xyz + weights.z * c.intoLumen.xyz;
    return WallPlace(place.xyz, inwards / max(length(inwards), 1e-6), place.w);
}

struct Sight {
    vec3 ray;    // unit, from the camera to the place
    vec3 light;  // unit, from a lamp ahead of the camera
};

Sight sightOf(WallPlace wall) {
    int index = clamp(int(floor(wall.camera)), 0, flatWindow.picture.w);
    FlatEye at = cameras[index];
    FlatEye next = cameras[min(index + 1, flatWindow.picture.w)];
    float share = clamp(wall.camera - float(index), 0.0, 1.0);
    vec3 sight = wall.placeMm - mix(at.placeMm.xyz, next.placeMm.xyz, share);
    vec3 ray = dot(sight, sight) > 1e-12 ? normalize(sight) : -wall.intoLumen;
    vec3 light = ray - flatWindow.angles.z * mix(at.ahead.xyz, next.ahead.xyz, share);
    return Sight(ray, dot(light, light) > 1e-12 ? normalize(light) : ray);
}

// A direction turned towards the wall's normal, in the plane of both, so that it meets the wall
// from the lumen: the angle a between them becomes a / (1 + (a / most)⁴)^¼, which leaves small
// angles as they are.
vec3 turned(vec3 direction, vec3 intoLumen, float most) {
    float facing = clamp(-dot(direction, intoLumen), -1.0, 1.0);
    vec3 along = direction + facing * intoLumen;
    float angle = acos(facing);
    float square = angle * angle / (most * most);
    angle *= inversesqrt(sqrt(1.0 + square * square));
    return sin(angle) * along * inversesqrt(max(dot(along, along), 1e-12)) - cos(angle) * intoLumen;
}

// How many steps before the wall a ray starts: at the darkest sample, going back from the wall
// through the open lumen. What rises again ends the way: something stands before the wall.
// Second, the step on the ray's way to the wall from which samples may be visible.
vec2 stepsBack(vec3 wall, vec3 step) {
    float least = textureLod(volume, wall, 0.0).r;
    float back = 0.0;
    float visible = 0.0;
    bool open = true;
    float before = least;
    for (float n = 1.0; open && n <= flatWindow.ray.x; n += 1.0) {
        float stored = textureLod(volume, wall - n * step, 0.0).r;
        open = stored < least + flatWindow.ray.y;
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
    ivec2 triangle = texelFetch(triangleOfPixel, min(pixel, u.pictureSize.xy - 1), 0).xy;
    WallPlace wall = placeAt(pixel, triangle);
    Ray ray;
    Sight sight = sightOf(wall);
    ray.directionMm = turned(sight.ray, wall.intoLumen, flatWindow.angles.x);
    ray.lightMm = turned(sight.light, wall.intoLumen, flatWindow.angles.y);
    ray.step = textureVector(ray.directionMm) * u.stepping.x;
    // Samples lie at whole steps from the wall's place, so that neighbouring rays meet the wall in
    // the same way.
    vec3 place = 0.5 + textureVector(wall.placeMm);
    vec2 start = stepsBack(place, ray.step);
    ray.origin = place - start.x * ray.step;
    vec2 inside = insideRange(ray);
    float end = triangle.x < 0 ? -1.0 : min(floor(inside.y), start.x + flatWindow.ray.z);
    vec4 sum = march(ray, max(ceil(inside.x), start.y), end);
    if (all(lessThan(pixel, u.pictureSize.xy))) imageStore(picture, pixel, pixelColor(sum, vec3(0.0)));
}
