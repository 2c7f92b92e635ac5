// From a place of the flattened wall to the ray that shows it (dissertation §4.3.2);
// server/render/native/flat_wall-inl.h says the same for packets.
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
    dvec2 latticePixel = dvec2(flatWindow.lattice - 1 - pixel) + 0.5 + flatWindow.phase;
    ivec2 here = ivec2(floor(latticePixel * flatWindow.unitsPerPixel + 0.5));
    here.x -= triangle.y * flatWindow.unitsPerCircumference;
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
    vec3 place = weights.x * a.placeMm + weights.y * b.placeMm + weights.z * c.placeMm;
    float camera = weights.x * a.camera + weights.y * b.camera + weights.z * c.camera;
    vec3 inwards = weights.x * a.intoLumen.xyz + weights.y * b.intoLumen.xyz + weights.z * c.intoLumen.xyz;
    return WallPlace(place, inwards / max(length(inwards), 1e-6), camera);
}

struct Sight {
    vec3 ray;    // unit, from the camera to the place
    vec3 light;  // unit, from a lamp ahead of the camera
};

Sight sightOf(WallPlace wall) {
    int index = clamp(int(floor(wall.camera)), 0, flatWindow.lastCamera);
    FlatEye at = cameras[index];
    FlatEye next = cameras[min(index + 1, flatWindow.lastCamera)];
    float share = clamp(wall.camera - float(index), 0.0, 1.0);
    vec3 sight = wall.placeMm - mix(at.placeMm.xyz, next.placeMm.xyz, share);
    vec3 ray = dot(sight, sight) > 1e-12 ? normalize(sight) : -wall.intoLumen;
    vec3 light = ray - flatWindow.lampAhead * mix(at.ahead.xyz, next.ahead.xyz, share);
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
