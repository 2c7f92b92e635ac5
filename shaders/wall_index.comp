// One pixel a thread: the place of the wall that its ray meets first (dissertation §6.3.1).
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f, binding = 0) uniform writeonly image2D places;
layout(binding = 4) uniform isampler2D triangleOfPixel;
layout(std430, binding = 1) readonly buffer FlatTriangles { uint corners[]; };

// Where on its triangle a ray is, and how far: x, y: flat coordinates, z: mm.
vec4 placeOn(int triangle, LensRay ray) {
    FlatVertex a = flatVertices[corners[3 * triangle]];
    FlatVertex b = flatVertices[corners[3 * triangle + 1]];
    FlatVertex c = flatVertices[corners[3 * triangle + 2]];
    vec3 ab = b.placeMm - a.placeMm;
    vec3 ac = c.placeMm - a.placeMm;
    vec3 fromA = ray.fromEye + wall.eyeMm - a.placeMm;
    // Möller and Trumbore's test.
    vec3 p = cross(ray.direction, ac);
    float determinant = dot(ab, p);
    float inverse = determinant != 0.0 ? 1.0 / determinant : 0.0;
    vec3 q = cross(fromA, ab);
    // A pixel may lie beside the triangle that was found to cover it: a hair, or up to half a
    // texel of a cube's side.
    vec2 weights = clamp(vec2(dot(fromA, p), dot(ray.direction, q)) * inverse, -0.5, 1.5);
    vec2 flatPlace = (vec2(a.flatPlace.xy) + weights.x * vec2(b.flatPlace.xy - a.flatPlace.xy) +
                      weights.y * vec2(c.flatPlace.xy - a.flatPlace.xy)) / wall.unitsPerCircumference;
    vec3 meets = weights.x * ab + weights.y * ac - fromA;
    return vec4(flatPlace, max(dot(meets, ray.direction), 0.0), 0.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(places)))) return;
    vec2 place = placeInPicture(vec2(pixel) + 0.5, wall.firstRow, wall.pictureSize);
    vec3 aside = place.x * wall.lensRight + place.y * wall.lensDown;
    LensRay ray = lensRay(wall.lens, wall.lensAhead, aside);
    ivec2 texel = pixel;
    if (wall.isCubeSide == 1) {
        vec2 onSide = vec2(dot(wall.right, ray.direction), dot(wall.down, ray.direction));
        float depth = dot(wall.forward, ray.direction);
        // This side's pixels alone; those of a shared edge may be drawn by both.
        if (depth <= 0.0 || max(abs(onSide.x), abs(onSide.y)) > depth * 1.000001) return;
        ivec2 sides = textureSize(triangleOfPixel, 0);
        texel = clamp(ivec2((0.5 * onSide / depth + 0.5) * vec2(sides)), ivec2(0), sides - 1);
    }
    int triangle = texelFetch(triangleOfPixel, texel, 0).x;
    bool seen = triangle >= 0 && isShown(wall.lens, aside);
    imageStore(places, pixel, seen ? placeOn(triangle, ray) : vec4(0.0, 0.0, -1.0, 0.0));
}
