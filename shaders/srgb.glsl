// sRGB's transfer curve (IEC 61966-2-1), and its inverse; processing/core/srgb.h in GLSL.
vec3 displayed(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

vec3 linearOf(vec3 displayed) {
    vec3 c = clamp(displayed, 0.0, 1.0);
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}
