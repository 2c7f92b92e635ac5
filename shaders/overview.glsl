// What the wall and the marks of the overview share.
layout(std140, binding = 0) uniform OverviewBlock { OverviewUniforms u; };
in vec4 placeMm;
in vec3 normal;
in vec3 color;

// sRGB's transfer curve (IEC 61966-2-1).
vec3 displayed(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

vec3 viewDirection() { return u.eye.w > 0.5 ? normalize(placeMm.xyz - u.eye.xyz) : u.forward.xyz; }

// Millimetres along the pixel's ray, as a backdrop counts them.
float alongRay() {
    vec3 from = placeMm.xyz - u.eye.xyz;
    return u.eye.w > 0.5 ? length(from) : dot(from, u.forward.xyz);
}

// A lamp beside the camera, a weaker one at it, and little light from everywhere: whichever side
// of the surface is seen is lit.
vec3 lit(float gloss) {
    vec3 view = viewDirection();
    vec3 outwards = normalize(normal);
    outwards = dot(outwards, view) > 0.0 ? -outwards : outwards;
    float key = max(dot(outwards, u.light.xyz), 0.0);
    float fill = max(-dot(outwards, view), 0.0);
    float highlight = pow(max(dot(outwards, normalize(u.light.xyz - view)), 0.0), 24.0);
    return color * (0.10 + 0.62 * key + 0.28 * fill) + gloss * highlight;
}
