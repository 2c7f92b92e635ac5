#include "render/native/packets.h"
#include "render/scene/picture.h"

// This text is compiled once for each vector unit, by an include that must come before others.
// clang-format off
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/native/camera_packets.cpp"
#include <hwy/foreach_target.h>
#include "render/native/lens-inl.h"
#include "render/native/march-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace haustra::render {
namespace HWY_NAMESPACE {

namespace {

constexpr int coneSide = 8;  // pixels of a tile whose rays share the way through empty space

/// For the cone of rays through each tile of pixels: the step up to which none of them can meet
/// anything visible. (x, y): the tiles' corners.
HWY_INLINE VF coneStart(const PacketScene& scene, VF x, VF y) {
    const VF zero = hn::Zero(f), half = set(0.5f * coneSide);
    const Rays axis = raysThrough(scene, hn::Add(x, half), hn::Add(y, half));
    const Range inside = insideRange(scene, axis);
    // How fast the rays at the tile's corners leave the axis, in voxels a step; of an orthographic
    // lens, how far they are from it. Directions between corners stay within this but for their
    // curvature: a twentieth more covers it where they do not differ much.
    VF spread = zero, beside = zero, leastCosine = set(1.0f);
    for (int corner = 0; corner < 4; ++corner) {
        const Rays ray = raysThrough(scene, hn::Add(x, set(float(corner & 1) * coneSide)),
                                     hn::Add(y, set(float(corner >> 1) * coneSide)));
        spread = hn::Max(spread, most({hn::AbsDiff(ray.step.x, axis.step.x),
                                       hn::AbsDiff(ray.step.y, axis.step.y),
                                       hn::AbsDiff(ray.step.z, axis.step.z)}));
        beside = hn::Max(beside, most({hn::AbsDiff(ray.origin.x, axis.origin.x),
                                       hn::AbsDiff(ray.origin.y, axis.origin.y),
                                       hn::AbsDiff(ray.origin.z, axis.origin.z)}));
        leastCosine = hn::Min(leastCosine, dot(ray.directionMm, axis.directionMm));
    }
    const VF widening = hn::Mul(set(1.05f), spread);
    const VF apart = hn::Mul(set(1.001f), beside);
    const VF speed =
        hn::Add(most({hn::Abs(axis.step.x), hn::Abs(axis.step.y), hn::Abs(axis.step.z)}), widening);
    // Only where the eye is inside: from outside, a tile's rays enter at different steps.
    VF n = zero;
    MF going = hn::And(hn::And(hn::Le(inside.first, zero), hn::Lt(n, inside.last)),
                       hn::Ge(leastCosine, set(0.9f)));
    while (any(going)) {
        const V3 place = along(axis.origin, n, axis.step);
        const Blocks blocks = blocksAt(scene, place);
        const VF side = hn::Add(blocks.distance, blocks.distance), two = set(2.0f);
        const auto room1 = [&](VF p, VF low) HWY_ATTR {
            const VF inBlock = hn::Sub(p, low);
            return hn::Min(hn::Add(inBlock, hn::Sub(side, two)), hn::Sub(side, inBlock));
        };
        const VF room = least({room1(place.x, blocks.low.x), room1(place.y, blocks.low.y),
                               room1(place.z, blocks.low.z)});
        const VF steps = hn::Floor(hn::Sub(
            hn::Div(hn::Sub(hn::Sub(room, apart), hn::Mul(n, widening)), speed), set(0.001f)));
        going = hn::And(going, hn::And(hn::Gt(blocks.distance, zero), hn::Gt(steps, zero)));
        n = hn::Add(n, hn::IfThenElseZero(going, steps));
        going = hn::And(going, hn::Lt(n, inside.last));
    }
    return n;
}

/// What lies behind a packet's pixels; linear light, and in `a` the millimetres at which rays end.
HWY_INLINE Color backdropOf(const PacketScene& scene, const PacketPicture& picture, int left,
                            int top) {
    if (!picture.backdrop) return {hn::Zero(f), hn::Zero(f), hn::Zero(f), set(1e30f)};
    float pixels[4][lanes];
    for (int lane = 0; lane < lanes; ++lane) {
        const int x = HWY_MIN(left + lane % packetWidth, scene.u.pictureSize.x - 1);
        const int y = HWY_MIN(top + lane / packetWidth, scene.u.pictureSize.y - 1);
        const glm::vec4& pixel =
            picture.backdrop[std::int64_t(y) * scene.u.pictureSize.x + std::int64_t(x)];
        for (int c = 0; c < 4; ++c)
            pixels[c][lane] = pixel[c];
    }
    return {hn::LoadU(f, pixels[0]), hn::LoadU(f, pixels[1]), hn::LoadU(f, pixels[2]),
            hn::LoadU(f, pixels[3])};
}

template <class AnyVoxels>
HWY_INLINE void castPacket(const PacketScene& scene, const VolumeSampler<AnyVoxels>& sampler,
                           const PacketPicture& picture, float start, int left, int top) {
    const VF half = set(0.5f);
    const V3 aside = asideMm(scene, hn::Add(laneX(), hn::Add(set(float(left)), half)),
                             hn::Add(laneY(), hn::Add(set(float(top)), half)));
    const Rays rays = raysAlong(scene, aside);
    const Range inside = insideRange(scene, rays);
    const Color backdrop = backdropOf(scene, picture, left, top);
    const VF end = hn::Floor(hn::Min(inside.last, hn::Div(backdrop.a, set(scene.u.stepMm))));
    const Color sum = march(scene, sampler, rays, hn::Max(hn::Ceil(inside.first), set(start)),
                            hn::IfThenElse(isInPicture(scene, aside), end, set(-1.0f)));
    Bytes bytes;
    pixelColors(scene, sum, backdrop, bytes);
    storePixels(picture.rgb, scene.u.pictureSize.x, picture.firstRow, picture.endRow, bytes, left,
                top);
}

template <class AnyVoxels>
void castTile(const PacketScene& scene, const PacketPicture& picture, int x, int y) {
    const VolumeSampler<AnyVoxels> sampler(scene);
    const int left = x * packetWidth * coneSide, top = y * packetHeight * coneSide;
    float starts[lanes];
    hn::StoreU(coneStart(scene, hn::MulAdd(laneX(), set(coneSide), set(float(left))),
                         hn::MulAdd(laneY(), set(coneSide), set(float(top)))),
               f, starts);
    for (int cone = 0; cone < lanes; ++cone) {
        const int coneLeft = left + cone % packetWidth * coneSide;
        const int coneTop = top + cone / packetWidth * coneSide;
        for (int py = coneTop; py < coneTop + coneSide; py += packetHeight) {
            if (py >= picture.endRow || py + packetHeight <= picture.firstRow) continue;
            for (int px = coneLeft; px < coneLeft + coneSide; px += packetWidth)
                if (px < scene.u.pictureSize.x)
                    castPacket(scene, sampler, picture, starts[cone], px, py);
        }
    }
}

void cast(const PacketScene& scene, const PacketPicture& picture, int x, int y) {
    if (scene.isFar()) return castTile<FarVoxels>(scene, picture, x, y);
    castTile<NearVoxels>(scene, picture, x, y);
}

CameraPackets packets() {
    return {packetWidth * coneSide, packetHeight * coneSide, cast};
}

}  // namespace

}  // namespace HWY_NAMESPACE
}  // namespace haustra::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace haustra::render {

HWY_EXPORT(packets);

CameraPackets cameraPackets() {
    return HWY_DYNAMIC_DISPATCH(packets)();
}

}  // namespace haustra::render
#endif
