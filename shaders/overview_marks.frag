// Path, reader and bookmarks, as displayed. They show through the wall, the less the farther behind
// it they are.
layout(binding = 0) uniform sampler2D wallPicture;
layout(location = 0) out vec4 mark;

void main() {
    float behind = alongRay() - texelFetch(wallPicture, ivec2(gl_FragCoord.xy), 0).w;
    float shown = mix(1.0, shownBehind, smoothstep(0.0, u.fadeMm, behind));
    mark = vec4(displayed(lit(0.15)), shown);
}
