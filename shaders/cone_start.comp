// One tile of pixels a thread: follows the cone that holds the tile's rays through empty space
// and stores the step up to which none of them can meet anything visible.
layout(local_size_x = 8, local_size_y = 8) in;
layout(r32f, binding = 1) uniform writeonly image2D firstStep;

void main() {
    ivec2 tile = tileOfGroup() * ivec2(gl_WorkGroupSize.xy) + ivec2(gl_LocalInvocationID.xy);
    float side = float(u.coneTileSide);
    vec2 low = vec2(tile) * side;
    Ray axis = rayThrough(low + 0.5 * side);
    vec2 inside = insideRange(axis);
    Blocks blocks = blocksOf(axis);
    vec3 step = axis.step * u.blocksPerUnit;
    // How fast the rays at the tile's corners leave the axis, in blocks a step; of an orthographic
    // lens, how far they are from it. Directions between corners stay within this but for their
    // curvature: a twentieth more covers it where they do not differ much.
    vec3 spread = vec3(0.0);
    vec3 beside = vec3(0.0);
    float leastCosine = 1.0;
    for (int corner = 0; corner < 4; ++corner) {
        Ray ray = rayThrough(low + side * vec2(corner & 1, corner >> 1));
        spread = max(spread, abs(ray.step * u.blocksPerUnit - step));
        beside = max(beside, abs((ray.origin - axis.origin) * u.blocksPerUnit));
        leastCosine = min(leastCosine, dot(ray.directionMm, axis.directionMm));
    }
    float widening = 1.05 * max(spread.x, max(spread.y, spread.z));
    float apart = 1.001 * max(beside.x, max(beside.y, beside.z));
    float speed = max(abs(step.x), max(abs(step.y), abs(step.z))) + widening;

    // Only where the eye is inside: from outside, a tile's rays enter at different steps.
    float n = 0.0;
    float margin = inside.x > 0.0 || leastCosine < 0.9 ? 0.0 : 1.0;
    while (margin > 0.0 && n < inside.y) {
        vec3 position = axis.origin + n * axis.step;
        ivec3 block = blockAt(blocks, position);
        float distance = float(texelFetch(leapDistance, block, 0).r);
        vec3 inBlock = blockCoordinate(blocks, position) - vec3(block);
        vec3 room = min(inBlock + (distance - 1.0), distance - inBlock);
        float steps = floor((min(room.x, min(room.y, room.z)) - apart - n * widening) / speed - 0.001);
        margin = distance > 0.0 ? steps : 0.0;
        n += max(margin, 0.0);
    }
    imageStore(firstStep, tile, vec4(n));
}
