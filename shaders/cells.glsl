// Rays among cells (dissertation §5.2): which samples of a ray belong to a cell, and, in place of
// volume.glsl, what is in it.
#ifndef COLOR_CELLS
#define COLOR_CELLS 0
#endif
layout(std140, binding = 3) uniform CellBlock { CellUniforms cells; };
// The slots of all cells.
layout(binding = 0) uniform sampler3D volume;

// The first n beyond the face before cell k + side, where a ray's coordinate is `start` at n = 0.
// `precise`: two cells must find the same number for the face between them.
float faceAt(float k, float start, float inverseStep) {
    precise float n = ceil((k - start) * inverseStep);
    return n;
}

// The samples of the ray that belong to the cell: first, and one after the last. Each sample
// belongs to one cell: to the one that the ray is in when it has passed a face at or before it.
// The outermost cells hold what is beyond them.
vec2 samplesInCell(Ray ray, ivec3 cell) {
    vec3 start = cells.raysBeginAtEye == 1.0 ? cells.eye : ray.origin * cells.cellsPerUnit + cells.firstCell;
    vec3 step = ray.step * cells.cellsPerUnit;
    step = mix(step, vec3(1e-12), equal(step, vec3(0.0)));
    vec3 inverse = 1.0 / step;
    vec2 samples = vec2(0.0, 1e30);
    for (int axis = 0; axis < 3; ++axis) {
        float low = cell[axis] == 0 ? -1e30 * sign(step[axis])
                                    : faceAt(float(cell[axis]), start[axis], inverse[axis]);
        float high = cell[axis] == cells.lastCell[axis]
                         ? 1e30 * sign(step[axis])
                         : faceAt(float(cell[axis] + 1), start[axis], inverse[axis]);
        samples = vec2(max(samples.x, min(low, high)), min(samples.y, max(low, high)));
    }
    return samples;
}

// The cell that this invocation samples.
CellInSlot cell = CellInSlot(ivec4(0), vec4(0.0), vec4(0.0));

// Places in a slot lie on a lattice of 1/4096 voxel, to which they are rounded before the slot counts:
// then all that follows is exact, whichever slot the cell is in and however far it reaches beyond
// the cell, for the atlas has sides of powers of two.
vec3 inSlot(vec3 position) {
    precise vec3 voxel = position * cells.voxels;
    precise vec3 onLattice = floor(voxel * 4096.0 + 0.5) * (1.0 / 4096.0);
    return onLattice - cell.corner.xyz;
}
vec4 texelInSlot(vec3 place) {
    return textureLod(volume, (place + cell.slot.xyz) * cells.atlasPerVoxel.xyz, 0.0);
}

#if COLOR_CELLS
// Voxels have colours of their own, as displayed, and opacity for 1 mm, whose gradient makes surfaces.
#define SAMPLE vec4
float valueInSlot(vec3 place) { return texelInSlot(place).a; }
SAMPLE sampleAt(vec3 position) { return texelInSlot(inSlot(position)); }
bool mayShow(SAMPLE texel) { return texel.a > 0.0; }
vec4 classify(SAMPLE texel, float gradientMagnitude) {
    return vec4(linearOf(texel.rgb), 1.0 - pow(max(1.0 - texel.a, 0.0), u.stepMm));
}
#else
#define SAMPLE float
float valueInSlot(vec3 place) { return texelInSlot(place).r; }
SAMPLE sampleAt(vec3 position) { return valueInSlot(inSlot(position)); }
#endif

// As in volume.glsl; what would be read beyond the slot has no weight, and is not another cell's.
vec3 gradientAt(vec3 position) {
    vec3 place = inSlot(position);
    vec3 low = max(place - 1.0, 0.5);
    vec3 high = min(place + 1.0, cells.slotSide - 0.5);
    vec3 differences = vec3(valueInSlot(vec3(high.x, place.yz)) - valueInSlot(vec3(low.x, place.yz)),
                            valueInSlot(vec3(place.x, high.y, place.z)) - valueInSlot(vec3(place.x, low.y, place.z)),
                            valueInSlot(vec3(place.xy, high.z)) - valueInSlot(vec3(place.xy, low.z)));
    return differences * cells.voxels;
}
