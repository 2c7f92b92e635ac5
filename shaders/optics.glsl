// The optical model (render/optics/optics.h), one sample or segment at a time: classification, light,
// compositing, and what a pixel shows in the end. Nothing here knows where values come from or in
// which order they are visited; the C++ of the native raycaster says the same line by line.
//
// Variants, each 0 unless it is defined before this text (render/gl/march_variant.h):
#define EMISSION_ABSORPTION 0
#define MAXIMUM_INTENSITY 1
#define FIRST_HIT 2
#ifndef COMPOSITION
#define COMPOSITION EMISSION_ABSORPTION
#endif
#ifndef PRE_INTEGRATED
#define PRE_INTEGRATED 0
#endif
#ifndef GRADIENT_ROWS
#define GRADIENT_ROWS 0
#endif
#ifndef SHADING
#define SHADING 0
#endif

layout(std140, binding = 0) uniform MarchBlock { MarchUniforms u; };
// Linear colour, and opacity of one step (emission-absorption) or of 1 mm, by stored value.
#if GRADIENT_ROWS
layout(binding = 2) uniform sampler2D transferTable;
#else
layout(binding = 2) uniform sampler1D transferTable;
#endif
#if PRE_INTEGRATED
// From the first entry on: rgb, colour times extinction; a, extinction; per entry and step.
layout(binding = 5) uniform sampler1D integralTable;
#endif

// Colour and opacity of a sample. `gradientMagnitude` is the length of its normal.
vec4 classify(float stored, float gradientMagnitude) {
    float entry = stored * u.entryScale + u.entryBias;
#if GRADIENT_ROWS
    return textureLod(transferTable, vec2(entry, gradientMagnitude * u.rowScale + u.rowBias), 0.0);
#else
    return textureLod(transferTable, entry, 0.0);
#endif
}

#if PRE_INTEGRATED
// The integral up to an entry; beyond the table its ends go on.
vec4 integralTo(float entry) {
    float last = float(textureSize(integralTable, 0) - 1);
    vec4 within = textureLod(integralTable, (clamp(entry, 0.0, last) + 0.5) / (last + 1.0), 0.0);
    return within + min(entry, 0.0) * u.integralBelow + max(entry - last, 0.0) * u.integralAbove;
}

// Colour and opacity of the segment between two samples, one step long, in which the value runs
// linearly from one to the other [Engel et al. 2001]. Values closer than an entry of the table
// count as an entry apart, lest their difference drown in rounding.
vec4 classifySegment(float front, float back) {
    float last = float(textureSize(integralTable, 0) - 1);
    vec2 ends = (vec2(front, back) * u.entryScale + u.entryBias) * (last + 1.0) - 0.5;
    float middle = 0.5 * (ends.x + ends.y);
    float reach = 0.5 * max(abs(ends.y - ends.x), 1.0);
    vec4 between = max(integralTo(middle + reach) - integralTo(middle - reach), 0.0);
    float opacity = 1.0 - exp(-between.a / (2.0 * reach));
    return vec4(between.rgb / max(between.a, 1e-20), opacity);
}
#endif

// Whether a stored value may be visible, or first hit; of a 2-D table, at some gradient.
bool mayShow(float stored) { return stored > u.visibleAbove && stored < u.visibleBelow; }
// The same of a segment.
bool mayShow(float front, float back) {
    return max(front, back) > u.visibleAbove && min(front, back) < u.visibleBelow;
}

// A gradient, differences over two voxels as gradientAt gives it, in the patient: it transforms by
// the inverse transpose of patientFromTexture. Twice as long as the gradient, stored value per mm.
vec3 normalOf(vec3 gradientTexture) {
    return gradientTexture.x * u.textureRowX + gradientTexture.y * u.textureRowY +
           gradientTexture.z * u.textureRowZ;
}

// A lamp, seen from where it hangs, `n` steps away; colours are linear light, `lightMm` is unit.
vec3 shade(vec3 color, vec3 normal, vec3 lightMm, float n) {
    float squared = dot(normal, normal);
    // Light comes along the line of sight, so N·L = N·V = R·V's half angle; both faces are lit. Where
    // the volume is flat there is no surface, and nothing to shade.
    float facing = squared > 1e-20 ? abs(dot(normal, lightMm)) * inversesqrt(squared) : 1.0;
    float depth = n * u.stepMm / u.lightHalvesMm;
    float falloff = 1.0 / (1.0 + depth * depth);
    float mirror = max(2.0 * facing * facing - 1.0, 0.0);
    float highlight = squared > 1e-20 ? u.specular * pow(mirror, u.shininess) : 0.0;
    return falloff * (color * (u.ambient + u.diffuse * facing) + highlight);
}

// Front to back, equation 5.1: `sum` with what lies behind it.
vec4 behind(vec4 sum, vec3 color, float opacity) {
    float share = (1.0 - sum.a) * opacity;
    return sum + vec4(share * color, share);
}

// Whether a ray goes on that has gathered this: of maximum intensity x is the greatest value.
bool isLive(vec4 sum) {
#if COMPOSITION == MAXIMUM_INTENSITY
    return sum.x < u.lastVisible;
#else
    return sum.a < u.terminationOpacity;
#endif
}

// What a ray has gathered at its end.
vec4 finished(vec4 sum) {
#if COMPOSITION == MAXIMUM_INTENSITY
    vec4 here = classify(sum.x, 0.0);
    return mayShow(sum.x) ? vec4(here.rgb * here.a, here.a) : vec4(0.0);
#else
    return sum;
#endif
}

// What a ray's pixel shows: its sum, before the linear light that comes from behind.
vec4 pixelColor(vec4 sum, vec3 backdrop) {
    vec3 color = sum.rgb + (1.0 - sum.a) * backdrop;
#if COMPOSITION != MAXIMUM_INTENSITY
    // A ray that was ended early counts as opaque, or its pixel would be darker than its neighbours.
    color = sum.a >= u.terminationOpacity ? sum.rgb / sum.a : color;
#endif
    return vec4(displayed(color), 1.0);
}
