// From places of the flattened wall to the rays that show them: shaders/flat_wall.glsl in vectors.
#if defined(HAUSTRA_FLAT_WALL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAUSTRA_FLAT_WALL_INL_H
#undef HAUSTRA_FLAT_WALL_INL_H
#else
#define HAUSTRA_FLAT_WALL_INL_H
#endif

#include "render/native/packets.h"
#include "render/native/volume_sampler-inl.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace haustra::render {
namespace HWY_NAMESPACE {

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

/// The flat coordinates, in units, that a pixel shows of a copy of the strip.
inline glm::ivec2 flatPlaceOf(const shaders::FlatUniforms& u, glm::ivec2 pixel, int copy) {
    const auto units = [&](int axis) {
        const double pixels = double(u.lattice[axis] - 1 - pixel[axis]) + 0.5 + u.phase[axis];
        return std::int32_t(std::floor(pixels * u.unitsPerPixel + 0.5));
    };
    return {units(0) - copy * u.unitsPerCircumference, units(1)};
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
                          camera = offsetof(shaders::FlatVertex, camera),
                          inwards = offsetof(shaders::FlatVertex, intoLumen);
    for (int c = 0; c < 3; ++c) {
        places.placeMm =
            along(places.placeMm, weight[c], vectorsOf(wall.vertices, corner[c], place));
        places.intoLumen =
            along(places.intoLumen, weight[c], vectorsOf(wall.vertices, corner[c], inwards));
        places.camera =
            hn::MulAdd(weight[c], floatsOf(wall.vertices, corner[c], camera), places.camera);
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
    const float last = float(wall.u.lastCamera);
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
    const V3 light = along(ray, set(-wall.u.lampAhead), mixed(offsetof(shaders::FlatEye, ahead)));
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

}  // namespace HWY_NAMESPACE
}  // namespace haustra::render
HWY_AFTER_NAMESPACE();
#endif
