// What the wall and the marks of the overview share.
layout(std140, binding = 0) uniform OverviewBlock { OverviewUniforms u; };
in vec3 placeMm;
in float shownBehind;
in vec3 normal;
in vec3 color;

vec3 viewDirection() { return u.raysBeginAtEye > 0.5 ? normalize(placeMm - u.eye) : u.forward; }

// Millimetres along the pixel's ray, as a backdrop counts them.
float alongRay() {
    vec3 from = placeMm - u.eye;
    return u.raysBeginAtEye > 0.5 ? length(from) : dot(from, u.forward);
}

// A lamp beside the camera, a weaker one at it, and little light from everywhere: whichever side
// of the surface is seen is lit.
vec3 lit(float gloss) {
    vec3 view = viewDirection();
    vec3 outwards = normalize(normal);
    outwards = dot(outwards, view) > 0.0 ? -outwards : outwards;
    float key = max(dot(outwards, u.light), 0.0);
    float fill = max(-dot(outwards, view), 0.0);
    float highlight = pow(max(dot(outwards, normalize(u.light - view)), 0.0), 24.0);
    return color * (0.10 + 0.62 * key + 0.28 * fill) + gloss * highlight;
}
