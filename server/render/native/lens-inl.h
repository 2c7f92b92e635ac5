// How a lens spreads a packet of rays over the picture: shaders/lens.glsl in vectors.
#if defined(HAUSTRA_LENS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAUSTRA_LENS_INL_H
#undef HAUSTRA_LENS_INL_H
#else
#define HAUSTRA_LENS_INL_H
#endif

#include "render/native/march-inl.h"
#include "render/native/packets.h"
#include "render/scene/picture.h"

HWY_BEFORE_NAMESPACE();
namespace haustra::render {
namespace HWY_NAMESPACE {

/// Places of the picture (pixels; centres at halves), from its centre; see LensFrame.
HWY_INLINE V3 asideMm(const PacketScene& scene, VF x, VF y) {
    const shaders::MarchUniforms& u = scene.u;
    const VF one = set(1.0f);
    const VF across = hn::MulSub(x, set(2.0f / float(u.pictureSize.x)), one);
    const VF down = hn::MulSub(y, set(2.0f / float(u.pictureSize.y)), one);
    const auto component = [&](int axis) HWY_ATTR {
        return hn::MulAdd(across, set(u.rightMm[axis]), hn::Mul(down, set(u.downMm[axis])));
    };
    return {component(0), component(1), component(2)};
}

HWY_INLINE V3 unit(V3 v) {
    return scaled(v, hn::Div(set(1.0f), hn::Sqrt(dot(v, v))));
}

/// Samples lie at whole n from the eye, or from the camera's plane.
inline HWY_NOINLINE Rays raysAlong(const PacketScene& scene, V3 aside) {
    const shaders::MarchUniforms& u = scene.u;
    const V3 forward{set(u.forwardMm.x), set(u.forwardMm.y), set(u.forwardMm.z)};
    const auto eye = [&](int axis) HWY_ATTR {
        return set(u.eyeTexture[axis] * float(scene.size[axis]) - 0.5f);
    };
    Rays rays;
    rays.origin = {eye(0), eye(1), eye(2)};
    switch (Lens(u.lens)) {
        case Lens::perspective:
            rays.directionMm = unit(along(forward, set(1.0f), aside));
            break;
        case Lens::fisheye: {
            const VF angle = hn::Sqrt(dot(aside, aside));
            const VF sine = hn::Div(hn::Sin(f, angle), hn::Max(angle, set(1e-6f)));
            rays.directionMm = unit(along(scaled(forward, hn::Cos(f, angle)), sine, aside));
            break;
        }
        case Lens::orthographic:
            rays.directionMm = forward;
            rays.origin = along(rays.origin, set(1.0f), voxelVector(scene, aside));
    }
    rays.lightMm = rays.directionMm;
    rays.step = scaled(voxelVector(scene, rays.directionMm), set(u.stepMm));
    setInverseStep(rays);
    return rays;
}
HWY_INLINE Rays raysThrough(const PacketScene& scene, VF x, VF y) {
    return raysAlong(scene, asideMm(scene, x, y));
}

/// A fisheye shows nothing more than half a turn from its axis.
HWY_INLINE MF isInPicture(const PacketScene& scene, V3 aside) {
    const VF most = set(Lens(scene.u.lens) == Lens::fisheye ? 9.8696044f : 1e30f);
    return hn::Le(dot(aside, aside), most);
}

}  // namespace HWY_NAMESPACE
}  // namespace haustra::render
HWY_AFTER_NAMESPACE();
#endif
