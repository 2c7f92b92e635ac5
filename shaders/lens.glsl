// How a lens spreads its rays over the picture; server/render/scene/lens.h in GLSL. The numbers are
// render::Lens in order.
const int perspectiveLens = 0, fisheyeLens = 1, orthographicLens = 2;

struct LensRay {
    vec3 fromEye;    // where the ray begins
    vec3 direction;  // unit
};

// A pixel of the band (centres at halves) in the picture: −1…1 along both sides.
vec2 placeInPicture(vec2 pixel, int firstRow, ivec2 pictureSize) {
    return 2.0 * (pixel + vec2(0.0, firstRow)) / vec2(pictureSize) - 1.0;
}

// `aside`: from the picture's centre to the pixel; at depth 1 (perspective), as long as its angle in
// radians (fisheye), or the way itself (orthographic).
LensRay lensRay(int lens, vec3 forward, vec3 aside) {
    LensRay ray = LensRay(vec3(0.0), forward);
    if (lens == perspectiveLens) {
        ray.direction = normalize(forward + aside);
    } else if (lens == fisheyeLens) {
        float angle = length(aside);
        ray.direction = normalize(cos(angle) * forward + sin(angle) / max(angle, 1e-6) * aside);
    } else {
        ray.fromEye = aside;
    }
    return ray;
}

// A fisheye shows nothing more than half a turn from its axis.
bool isShown(int lens, vec3 aside) { return lens != fisheyeLens || dot(aside, aside) <= 9.8696044; }
