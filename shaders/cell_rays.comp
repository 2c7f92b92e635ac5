// One tile of pixels and one cell a group: the part of the tile's rays that is in the cell
// (dissertation §5.2.1, its four passes in one).
layout(local_size_x = 8, local_size_y = 8) in;
// Of each pixel: the sum so far; of maximum intensity, x: the greatest value.
layout(rgba32f, binding = 1) uniform image2D rays;
// x: tile, column | row << 16; y: cell.
layout(std430, binding = 0) readonly buffer CellItems { uvec2 items[]; };
layout(std430, binding = 1) readonly buffer CellSlots { CellInSlot inSlots[]; };
// Rays of each tile that have not ended; the CPU leaves out tiles that have none.
layout(std430, binding = 2) coherent buffer LiveRays { int liveRays[]; };

void main() {
    uint item = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (item >= uint(cells.items)) return;
    ivec2 tile = ivec2(items[item].x & 0xffffu, items[item].x >> 16);
    int tileIndex = tile.x + tile.y * cells.tiles.x;
    if (liveRays[tileIndex] == 0) return;
    cell = inSlots[items[item].y];
    ivec2 pixel = tile * ivec2(gl_WorkGroupSize.xy) + pixelOfLane(gl_LocalInvocationIndex);
    vec2 center = vec2(pixel) + 0.5;
    Ray ray = rayThrough(center);
    vec2 inside = insideRange(ray);
    vec2 samples = samplesInCell(ray, cell.cell.xyz);
    float first = ceil(inside.x);
    float begin = max(first, samples.x);
    float end = min(floor(min(inside.y, backdropOf(pixel).w / u.stepMm)), samples.y - 1.0);
    bool drawn = all(lessThan(pixel, imageSize(rays))) && isInPicture(center);
    vec4 before = imageLoad(rays, pixel);
    end = drawn && isLive(before) ? end : -1.0;
    vec4 after = marchOn(ray, before, first, begin, end);
    // Rays outside of the cell leave their pixel to another cell of the layer.
    if (begin <= end) {
        imageStore(rays, pixel, after);
        if (!isLive(after)) atomicAdd(liveRays[tileIndex], -1);
    }
}
