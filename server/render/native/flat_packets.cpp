#include "render/flat/flat_coverage.h"
#include "render/native/packets.h"

// This text is compiled once for each vector unit, by an include that must come before others.
// clang-format off
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/native/flat_packets.cpp"
#include <hwy/foreach_target.h>
#include "render/native/flat_wall-inl.h"
#include "render/native/march-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace haustra::render {
namespace HWY_NAMESPACE {

namespace {

struct Start {
    VF back;     // steps before the wall at which a ray starts
    VF visible;  // the step on its way to the wall from which samples may be visible
};

/// A ray starts at the darkest sample, going back from the wall through the open lumen. What rises
/// again ends the way: something stands before the wall.
template <class AnyVoxels>
HWY_INLINE Start startOf(const PacketScene& scene, const PacketWall& wall,
                         const VolumeSampler<AnyVoxels>& sampler, V3 place, V3 step, MF wanted) {
    const VF zero = hn::Zero(f), one = set(1.0f);
    VF least = sampler.value(onlyWhere(wanted, place));
    VF back = zero, visible = zero, before = least;
    MF open = wanted;
    for (float n = 1.0f; n <= wall.u.mostStepsBack && any(open); n += 1.0f) {
        const VF hu = sampler.value(onlyWhere(open, along(place, set(-n), step)));
        const MF darker = hn::And(open, hn::Lt(hu, least));
        const MF shows = hn::And(open, mayShow(scene, before, hu));
        const MF goesOn = hn::And(open, hn::Lt(hu, hn::Add(least, set(wall.u.riseThatEnds))));
        back = hn::IfThenElse(darker, set(n), back);
        least = hn::IfThenElse(darker, hu, least);
        visible = hn::IfThenElse(shows, set(n), visible);
        before = hu;
        open = goesOn;
    }
    // One more, where the segment to the first that is visible begins.
    return {back, hn::Sub(back, hn::Min(hn::Add(visible, one), back))};
}

template <class AnyVoxels>
HWY_INLINE void castPacket(const PacketScene& scene, const PacketWall& wall,
                           const VolumeSampler<AnyVoxels>& sampler, const PacketRows& rows,
                           int left, int top) {
    const int width = wall.u.pictureSize.x, endRow = rows.firstRow + rows.rows;
    std::int32_t triangle[lanes], x[lanes], y[lanes];
    bool covered = false;
    for (int lane = 0; lane < lanes; ++lane) {
        const int px = HWY_MIN(left + lane % packetWidth, width - 1);
        const int py = HWY_MIN(top + lane / packetWidth, endRow - 1);
        const FlatPixel pixel = rows.pixels[std::int64_t(py - rows.firstRow) * width + px];
        triangle[lane] = pixel.triangle;
        covered = covered || pixel.triangle >= 0;
        const glm::ivec2 place = flatPlaceOf(wall.u, {px, py}, pixel.copy);
        x[lane] = place.x;
        y[lane] = place.y;
    }
    Color total{hn::Zero(f), hn::Zero(f), hn::Zero(f), hn::Zero(f)};
    if (covered) {
        const VI number = hn::LoadU(i, triangle);
        const MF wanted = hn::RebindMask(f, hn::Gt(number, hn::Set(i, -1)));
        const WallPlaces places =
            placesAt(wall, hn::Max(number, hn::Zero(i)), hn::LoadU(i, x), hn::LoadU(i, y));
        const Sight sight = sightOf(wall, places);
        Rays rays;
        rays.directionMm = turned(sight.ray, places.intoLumen, wall.u.mostRayAngle);
        rays.lightMm = turned(sight.light, places.intoLumen, wall.u.mostLightAngle);
        rays.step = scaled(voxelVector(scene, rays.directionMm), set(scene.u.stepMm));
        setInverseStep(rays);
        // Samples lie at whole steps from the wall's place, so that neighbouring rays meet the wall
        // in the same way.
        const auto middle = [&](int axis)
                                HWY_ATTR { return set(0.5f * float(scene.size[axis]) - 0.5f); };
        const V3 place = sum({middle(0), middle(1), middle(2)}, voxelVector(scene, places.placeMm));
        const Start start = startOf(scene, wall, sampler, place, rays.step, wanted);
        rays.origin = along(place, hn::Neg(start.back), rays.step);
        const Range inside = insideRange(scene, rays);
        const VF last =
            hn::Min(hn::Floor(inside.last), hn::Add(start.back, set(wall.u.mostStepsOn)));
        total = march(scene, sampler, rays, hn::Max(hn::Ceil(inside.first), start.visible),
                      hn::IfThenElse(wanted, last, set(-1.0f)));
    }
    Bytes bytes;
    pixelColors(scene, total, {hn::Zero(f), hn::Zero(f), hn::Zero(f), hn::Zero(f)}, bytes);
    storePixels(rows.rgb, width, rows.firstRow, endRow, bytes, left, top);
}

template <class AnyVoxels>
void castRows(const PacketScene& scene, const PacketWall& wall, const PacketRows& rows) {
    const VolumeSampler<AnyVoxels> sampler(scene);
    for (int top = rows.firstRow; top < rows.firstRow + rows.rows; top += packetHeight)
        for (int left = 0; left < wall.u.pictureSize.x; left += packetWidth)
            castPacket(scene, wall, sampler, rows, left, top);
}

void castFlat(const PacketScene& scene, const PacketWall& wall, const PacketRows& rows) {
    if (scene.isFar()) return castRows<FarVoxels>(scene, wall, rows);
    castRows<NearVoxels>(scene, wall, rows);
}

CastFlat caster() {
    return castFlat;
}

}  // namespace

}  // namespace HWY_NAMESPACE
}  // namespace haustra::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace haustra::render {

HWY_EXPORT(caster);

CastFlat flatPackets() {
    return HWY_DYNAMIC_DISPATCH(caster)();
}

}  // namespace haustra::render
#endif
