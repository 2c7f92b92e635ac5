#include "render/native/flat_packets.h"

// This text is compiled once for each vector unit, by an include that must come before others.
// clang-format off
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/native/flat_packets.cpp"
#include <hwy/foreach_target.h>
#include "render/native/march-inl.h"
// clang-format on

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace haustra::render {
namespace HWY_NAMESPACE {

namespace {

template <class Record>
HWY_INLINE VF floatsOf(const Record* records, VI number, std::size_t offset) {
    const VI bytes = hn::Mul(number, hn::Set(i, std::int32_t(sizeof(Record))));
    return hn::GatherOffset(
        f, reinterpret_cast<const float*>(reinterpret_cast<const char*>(records) + offset), bytes);
}
template <class Record>
HWY_INLINE VI integersOf(const Record* records, VI number, std::size_t offset) {
    const VI bytes = hn::Mul(number, hn::Set(i, std::int32_t(sizeof(Record))));
    return hn::GatherOffset(
        i, reinterpret_cast<const std::int32_t*>(reinterpret_cast<const char*>(records) + offset),
        bytes);
}
template <class Record>
HWY_INLINE V3 vectorsOf(const Record* records, VI number, std::size_t offset) {
    return {floatsOf(records, number, offset), floatsOf(records, number, offset + 4),
            floatsOf(records, number, offset + 8)};
}

HWY_INLINE V3 sum(V3 a, V3 b) {
    return along(a, set(1.0f), b);
}
HWY_INLINE V3 difference(V3 a, V3 b) {
    return along(a, set(-1.0f), b);
}
HWY_INLINE V3 chosen(MF mask, V3 yes, V3 no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
            hn::IfThenElse(mask, yes.z, no.z)};
}
HWY_INLINE V3 opposite(V3 v) {
    return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)};
}

/// Places of the wall as the flat map has them; millimetres from the volume's centre.
struct WallPlaces {
    V3 placeMm;
    V3 intoLumen;  // unit
    VF camera;     // index into cameras, a fraction between two
};

/// The places that pixels show, by their barycentric coordinates in the triangles that cover them.
/// (x, y): flat coordinates, in units.
HWY_INLINE WallPlaces placesAt(const PacketWall& wall, VI triangle, VI x, VI y) {
    const VF zero = hn::Zero(f);
    VI corner[3];
    V3 to[3];  // x, y: from here to the corner
    for (int c = 0; c < 3; ++c) {
        corner[c] = integersOf(wall.triangles, triangle, std::size_t(4 * c));
        to[c].x = hn::ConvertTo(f, hn::Sub(integersOf(wall.vertices, corner[c], 0), x));
        to[c].y = hn::ConvertTo(f, hn::Sub(integersOf(wall.vertices, corner[c], 4), y));
    }
    const auto turn = [&](const V3& a, const V3& b)
                          HWY_ATTR { return hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x)); };
    // A pixel may lie a hair outside of the triangle that was found to cover it.
    V3 weights{hn::Max(turn(to[1], to[2]), zero), hn::Max(turn(to[2], to[0]), zero),
               hn::Max(turn(to[0], to[1]), zero)};
    const VF total = hn::Add(hn::Add(weights.x, weights.y), weights.z);
    const MF hasArea = hn::Gt(total, zero);
    const VF scale = hn::Div(set(1.0f), hn::IfThenElse(hasArea, total, set(1.0f)));
    const VF third = set(1.0f / 3.0f);
    weights = chosen(hasArea, scaled(weights, scale), {third, third, third});
    const VF weight[3] = {weights.x, weights.y, weights.z};
    WallPlaces places{{zero, zero, zero}, {zero, zero, zero}, zero};
    constexpr std::size_t place = offsetof(shaders::FlatVertex, placeMm),
                          inwards = offsetof(shaders::FlatVertex, intoLumen);
    for (int c = 0; c < 3; ++c) {
        places.placeMm =
            along(places.placeMm, weight[c], vectorsOf(wall.vertices, corner[c], place));
        places.intoLumen =
            along(places.intoLumen, weight[c], vectorsOf(wall.vertices, corner[c], inwards));
        places.camera =
            hn::MulAdd(weight[c], floatsOf(wall.vertices, corner[c], place + 12), places.camera);
    }
    const VF length = hn::Sqrt(dot(places.intoLumen, places.intoLumen));
    places.intoLumen = scaled(places.intoLumen, hn::Div(set(1.0f), hn::Max(length, set(1e-6f))));
    return places;
}

struct Sight {
    V3 ray;    // unit, from the camera to the place
    V3 light;  // unit, from a lamp ahead of the camera
};

/// A vector made unit where it is longer than nothing, else another.
HWY_INLINE V3 unitOr(V3 v, V3 other) {
    const VF square = dot(v, v), least = set(1e-12f);
    return chosen(hn::Gt(square, least),
                  scaled(v, hn::Div(set(1.0f), hn::Sqrt(hn::Max(square, least)))), other);
}

HWY_INLINE Sight sightOf(const PacketWall& wall, const WallPlaces& places) {
    const float last = float(wall.u.picture.w);
    const VF before = clamped(hn::Floor(places.camera), 0.0f, last);
    const VI at = hn::ConvertTo(i, before);
    const VI next = hn::ConvertTo(i, hn::Min(hn::Add(before, set(1.0f)), set(last)));
    const VF share = clamped(hn::Sub(places.camera, before), 0.0f, 1.0f);
    const auto mixed = [&](std::size_t offset) HWY_ATTR {
        const V3 a = vectorsOf(wall.cameras, at, offset);
        return along(a, share, difference(vectorsOf(wall.cameras, next, offset), a));
    };
    const V3 sight = difference(places.placeMm, mixed(offsetof(shaders::FlatEye, placeMm)));
    const V3 ray = unitOr(sight, opposite(places.intoLumen));
    const V3 light = along(ray, set(-wall.u.angles.z), mixed(offsetof(shaders::FlatEye, ahead)));
    return {ray, unitOr(light, ray)};
}

/// A direction turned towards the wall's normal, in the plane of both, so that it meets the wall
/// from the lumen (FlatRay).
HWY_INLINE V3 turned(V3 direction, V3 intoLumen, float most) {
    const VF facing = clamped(hn::Neg(dot(direction, intoLumen)), -1.0f, 1.0f), one = set(1.0f);
    const V3 beside = along(direction, facing, intoLumen);
    VF angle = hn::Acos(f, facing);
    const VF square = hn::Div(hn::Mul(angle, angle), set(most * most));
    angle = hn::Div(angle, hn::Sqrt(hn::Sqrt(hn::MulAdd(square, square, one))));
    const VF length = hn::Sqrt(hn::Max(dot(beside, beside), set(1e-12f)));
    return sum(scaled(beside, hn::Div(hn::Sin(f, angle), length)),
               scaled(intoLumen, hn::Neg(hn::Cos(f, angle))));
}

struct Start {
    VF back;     // steps before the wall at which a ray starts
    VF visible;  // the step on its way to the wall from which samples may be visible
};

/// A ray starts at the darkest sample, going back from the wall through the open lumen. What rises
/// again ends the way: something stands before the wall.
template <class AnyVoxels>
HWY_INLINE Start startOf(const PacketScene& scene, const PacketWall& wall,
                         const Lattice<AnyVoxels>& lattice, V3 place, V3 step, MF wanted) {
    const VF zero = hn::Zero(f), one = set(1.0f);
    VF least = lattice.value(onlyWhere(wanted, place));
    VF back = zero, visible = zero, before = least;
    MF open = wanted;
    for (float n = 1.0f; n <= wall.u.ray.x && any(open); n += 1.0f) {
        const VF hu = lattice.value(onlyWhere(open, along(place, set(-n), step)));
        const MF darker = hn::And(open, hn::Lt(hu, least));
        const MF shows = hn::And(open, mayShow(scene, before, hu));
        const MF goesOn = hn::And(open, hn::Lt(hu, hn::Add(least, set(wall.u.ray.y))));
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
                           const Lattice<AnyVoxels>& lattice, const PacketRows& rows, int left,
                           int top) {
    const int width = wall.u.picture.x, endRow = rows.firstRow + rows.rows;
    std::int32_t triangle[lanes], x[lanes], y[lanes];
    bool covered = false;
    for (int lane = 0; lane < lanes; ++lane) {
        const int px = HWY_MIN(left + lane % packetWidth, width - 1);
        const int py = HWY_MIN(top + lane / packetWidth, endRow - 1);
        const FlatPixel pixel = rows.pixels[std::int64_t(py - rows.firstRow) * width + px];
        triangle[lane] = pixel.triangle;
        covered = covered || pixel.triangle >= 0;
        const auto units = [&](int at, int axis) {
            const double pixels = double(wall.u.lattice[axis] - 1 - at) + 0.5 + wall.u.phase[axis];
            return std::int32_t(std::floor(pixels * wall.u.scale.x + 0.5));
        };
        x[lane] = units(px, 0) - pixel.copy * wall.u.lattice.z;
        y[lane] = units(py, 1);
    }
    Color total{hn::Zero(f), hn::Zero(f), hn::Zero(f), hn::Zero(f)};
    if (covered) {
        const VI number = hn::LoadU(i, triangle);
        const MF wanted = hn::RebindMask(f, hn::Gt(number, hn::Set(i, -1)));
        const WallPlaces places =
            placesAt(wall, hn::Max(number, hn::Zero(i)), hn::LoadU(i, x), hn::LoadU(i, y));
        const Sight sight = sightOf(wall, places);
        Rays rays;
        rays.directionMm = turned(sight.ray, places.intoLumen, wall.u.angles.x);
        rays.lightMm = turned(sight.light, places.intoLumen, wall.u.angles.y);
        rays.step = scaled(voxelVector(scene, rays.directionMm), set(scene.u.stepping.x));
        setInverseStep(rays);
        // Samples lie at whole steps from the wall's place, so that neighbouring rays meet the wall
        // in the same way.
        const auto middle = [&](int axis)
                                HWY_ATTR { return set(0.5f * float(scene.size[axis]) - 0.5f); };
        const V3 place = sum({middle(0), middle(1), middle(2)}, voxelVector(scene, places.placeMm));
        const Start start = startOf(scene, wall, lattice, place, rays.step, wanted);
        rays.origin = along(place, hn::Neg(start.back), rays.step);
        const Range inside = insideRange(scene, rays);
        const VF last = hn::Min(hn::Floor(inside.last), hn::Add(start.back, set(wall.u.ray.z)));
        total = march(scene, lattice, rays, hn::Max(hn::Ceil(inside.first), start.visible),
                      hn::IfThenElse(wanted, last, set(-1.0f)));
    }
    Bytes bytes;
    pixelColors(scene, total, {hn::Zero(f), hn::Zero(f), hn::Zero(f), hn::Zero(f)}, bytes);
    storePixels(rows.rgb, width, rows.firstRow, endRow, bytes, left, top);
}

template <class AnyVoxels>
void castRows(const PacketScene& scene, const PacketWall& wall, const PacketRows& rows) {
    const Lattice<AnyVoxels> lattice(scene);
    for (int top = rows.firstRow; top < rows.firstRow + rows.rows; top += packetHeight)
        for (int left = 0; left < wall.u.picture.x; left += packetWidth)
            castPacket(scene, wall, lattice, rows, left, top);
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
