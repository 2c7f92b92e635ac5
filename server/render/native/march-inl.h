// Ray packets on their way through the volume: shaders/march.glsl in vectors.
#if defined(HAUSTRA_MARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAUSTRA_MARCH_INL_H
#undef HAUSTRA_MARCH_INL_H
#else
#define HAUSTRA_MARCH_INL_H
#endif

#include "render/native/optics-inl.h"
#include "render/native/packets.h"

HWY_BEFORE_NAMESPACE();
namespace haustra::render {
namespace HWY_NAMESPACE {

/// A packet's rays, in voxels. Samples lie at whole n.
struct Rays {
    V3 origin, step;  // at n = 0; one step
    V3 directionMm;   // unit
    V3 lightMm;       // unit: which way the light falls
    V3 inverseStep;   // 1 / step, large where it is 0
};

HWY_INLINE void setInverseStep(Rays& rays) {
    rays.inverseStep = {reciprocalOrLarge(rays.step.x), reciprocalOrLarge(rays.step.y),
                        reciprocalOrLarge(rays.step.z)};
}

HWY_INLINE V3 voxelVector(const PacketScene& scene, V3 mm) {
    return {dot(scene.voxelFromMm[0], mm), dot(scene.voxelFromMm[1], mm),
            dot(scene.voxelFromMm[2], mm)};
}

struct Range {
    VF first, last;
};

/// The range of n in which rays are inside the volume, whose outer faces are half a voxel out.
HWY_INLINE Range insideRange(const PacketScene& scene, const Rays& rays) {
    const auto axis = [&](VF origin, VF inverse, int size) HWY_ATTR {
        const VF a = hn::Mul(hn::Sub(set(-0.5f), origin), inverse);
        const VF b = hn::Mul(hn::Sub(set(float(size) - 0.5f), origin), inverse);
        return Range{hn::Min(a, b), hn::Max(a, b)};
    };
    const Range x = axis(rays.origin.x, rays.inverseStep.x, scene.size[0]);
    const Range y = axis(rays.origin.y, rays.inverseStep.y, scene.size[1]);
    const Range z = axis(rays.origin.z, rays.inverseStep.z, scene.size[2]);
    return {hn::Max(most({x.first, y.first, z.first}), hn::Zero(f)),
            hn::Min(least({x.last, y.last, z.last}), set(scene.u.mostSteps))};
}

/// Blocks of the leap map that places lie in, their lower corners (voxels) and distances.
struct Blocks {
    V3 low;
    VF distance;
};
HWY_INLINE Blocks blocksAt(const PacketScene& scene, V3 place) {
    const auto along1 = [&](VF p, int axis) HWY_ATTR {
        return hn::Floor(clamped(hn::Mul(p, set(0.5f)), 0.0f, float(scene.lastBlock[axis])));
    };
    const V3 block{along1(place.x, 0), along1(place.y, 1), along1(place.z, 2)};
    const VI width = hn::Set(i, scene.lastBlock[0] + 1);
    const VI area = hn::Set(i, (scene.lastBlock[0] + 1) * (scene.lastBlock[1] + 1));
    const VI at =
        hn::Add(hn::ConvertTo(i, block.x), hn::Add(hn::Mul(hn::ConvertTo(i, block.y), width),
                                                   hn::Mul(hn::ConvertTo(i, block.z), area)));
    const VI four = hn::GatherOffset(i, reinterpret_cast<const std::int32_t*>(scene.leap), at);
    const VF distance = hn::ConvertTo(f, hn::And(four, hn::Set(i, 255)));
    return {{hn::Add(block.x, block.x), hn::Add(block.y, block.y), hn::Add(block.z, block.z)},
            distance};
}

/// Steps from `place` to the first that leaves the cube of empty blocks around its block.
HWY_INLINE VF stepsToLeave(const Rays& rays, V3 place, const Blocks& blocks) {
    const VF two = set(2.0f), toHigh = hn::Mul(two, blocks.distance), toLow = hn::Sub(two, toHigh);
    const auto leave = [&](VF p, VF low, VF inverse) HWY_ATTR {
        const VF inBlock = hn::Sub(p, low);
        return hn::Max(hn::Mul(hn::Sub(toLow, inBlock), inverse),
                       hn::Mul(hn::Sub(toHigh, inBlock), inverse));
    };
    const VF steps = least({leave(place.x, blocks.low.x, rays.inverseStep.x),
                            leave(place.y, blocks.low.y, rays.inverseStep.y),
                            leave(place.z, blocks.low.z, rays.inverseStep.z)});
    // A hair less, so that rounding never jumps over a sample just outside.
    return hn::Max(set(1.0f), hn::Ceil(hn::Sub(steps, set(0.001f))));
}

/// Where it is not wanted, a place whose voxels are near at hand.
HWY_INLINE V3 onlyWhere(MF wanted, V3 place) {
    return {hn::IfThenElseZero(wanted, place.x), hn::IfThenElseZero(wanted, place.y),
            hn::IfThenElseZero(wanted, place.z)};
}

/// Rays leap on together until each has come to a block that may be visible, has passed its `last`
/// step, or is `staying`; all are looked at together then. Who leaps leaves `known`, which tells
/// whether the value a step before is. Returns which rays are in an empty block.
HWY_INLINE MF leapt(const PacketScene& scene, const Rays& rays, VF last, MF staying, VF& n,
                    MF& searching, MF& known) {
    while (true) {
        const V3 place = along(rays.origin, n, rays.step);
        const Blocks blocks = blocksAt(scene, place);
        const MF empty = hn::Gt(blocks.distance, hn::Zero(f));
        const MF leaping = hn::AndNot(staying, hn::And(searching, empty));
        if (!any(leaping)) return empty;
        n = hn::Add(n, hn::IfThenElseZero(leaping, stepsToLeave(rays, place, blocks)));
        known = hn::AndNot(leaping, known);
        searching = hn::And(searching, hn::Le(n, last));
    }
}

/// Goes on until every ray has found a value that may be visible, or has come to its end. Where
/// something was visible the next sample is as a rule, too: it is looked at before the leap map.
struct Search {
    VF n, hu;
    MF found;
};
template <class AnyVoxels>
HWY_INLINE Search searched(const PacketScene& scene, const VolumeSampler<AnyVoxels>& sampler,
                           const Rays& rays, VF n, VF last, MF searching, bool lookFirst) {
    const VF zero = hn::Zero(f), one = set(1.0f);
    const MF none = hn::Lt(one, zero);
    Search search{n, zero, none};
    MF known = none;
    for (bool leap = !lookFirst; any(searching); leap = true) {
        if (leap) leapt(scene, rays, last, none, search.n, searching, known);
        if (!any(searching)) break;
        const V3 place = along(rays.origin, search.n, rays.step);
        const VF value = sampler.value(onlyWhere(searching, place));
        const MF visible = hn::And(searching, mayShow(scene, value));
        search.hu = hn::IfThenElse(visible, value, search.hu);
        search.found = hn::Or(search.found, visible);
        searching = hn::AndNot(visible, searching);
        search.n = hn::Add(search.n, hn::IfThenElseZero(searching, one));
        searching = hn::And(searching, hn::Le(search.n, last));
    }
    return search;
}

/// Emission and absorption by samples. As the other marches: colour (linear, multiplied by opacity)
/// and opacity along rays from n = `first` to `last`.
template <bool byGradient, class AnyVoxels>
HWY_NOINLINE Color marchSamples(const PacketScene& scene, const VolumeSampler<AnyVoxels>& sampler,
                                const Rays& rays, VF first, VF last) {
    const VF one = set(1.0f), zero = hn::Zero(f);
    Color sum{zero, zero, zero, zero};
    VF n = first;
    MF active = hn::Le(n, last);
    for (bool again = false; any(active); again = true) {
        const Search at = searched(scene, sampler, rays, n, last, active, again);
        if (!any(at.found)) break;
        n = at.n;
        const V3 place = along(rays.origin, n, rays.step);
        V3 normal{zero, zero, zero};
        if (byGradient) normal = normalOf(scene, sampler.gradient(place, at.found));
        Color here = byGradient ? classified(scene, at.hu, hn::Sqrt(dot(normal, normal)))
                                : classified(scene, at.hu);
        // Values may lie between two ranges that have opacity: their light is not seen.
        if (scene.shading && any(hn::And(at.found, hn::Gt(here.a, zero)))) {
            if (!byGradient) normal = normalOf(scene, sampler.gradient(place, at.found));
            here = shaded(scene, here, normal, rays.lightMm, n);
        }
        sum = behind(sum, here, at.found);
        n = hn::Add(n, one);
        active = hn::And(at.found,
                         hn::And(hn::Le(n, last), hn::Lt(sum.a, set(scene.u.terminationOpacity))));
    }
    return sum;
}

/// Emission and absorption by pre-integrated segments. A segment is worth a look where one of its
/// ends lies in a block that may be visible: others have no opacity, looked at or not.
template <class AnyVoxels>
HWY_NOINLINE Color marchSegments(const PacketScene& scene, const VolumeSampler<AnyVoxels>& sampler,
                                 const Rays& rays, VF first, VF last) {
    const VF one = set(1.0f), zero = hn::Zero(f), half = set(0.5f);
    const MF none = hn::Lt(one, zero);
    Color sum{zero, zero, zero, zero};
    VF n = first, front = zero;
    // Whether `front` is the value at n - 1, and whether that sample's block may be visible.
    MF known = none, near = none;
    MF active = hn::Le(n, last);
    for (bool again = false; any(active); again = true) {
        MF searching = active, found = none;
        VF back = zero;
        for (bool leap = !again; any(searching); leap = true) {
            MF empty = none;
            if (leap) empty = leapt(scene, rays, last, near, n, searching, known);
            if (!any(searching)) break;
            const MF asking = hn::AndNot(known, searching);
            if (any(asking)) {
                // The first sample stands for the way before it.
                const VF before = hn::Max(hn::Sub(n, one), first);
                const VF value =
                    sampler.value(onlyWhere(asking, along(rays.origin, before, rays.step)));
                front = hn::IfThenElse(asking, value, front);
                known = hn::Or(known, asking);
            }
            const VF value = sampler.value(onlyWhere(searching, along(rays.origin, n, rays.step)));
            const MF visible = hn::And(searching, mayShow(scene, front, value));
            back = hn::IfThenElse(visible, value, back);
            found = hn::Or(found, visible);
            near = hn::Or(hn::AndNot(searching, near), hn::AndNot(empty, searching));
            searching = hn::AndNot(visible, searching);
            front = hn::IfThenElse(searching, value, front);
            n = hn::Add(n, hn::IfThenElseZero(searching, one));
            searching = hn::And(searching, hn::Le(n, last));
        }
        if (!any(found)) break;
        Color here = classifiedSegment(scene, front, back);
        if (scene.shading) {
            const VF middle = hn::Sub(n, half);
            const V3 place = along(rays.origin, middle, rays.step);
            here = shaded(scene, here, normalOf(scene, sampler.gradient(place, found)),
                          rays.lightMm, middle);
        }
        sum = behind(sum, here, found);
        front = back;
        n = hn::Add(n, one);
        active = hn::And(found,
                         hn::And(hn::Le(n, last), hn::Lt(sum.a, set(scene.u.terminationOpacity))));
    }
    return sum;
}

/// The greatest value. The leap map lets rays leap over what lies below the first visible one.
template <class AnyVoxels>
HWY_NOINLINE Color marchMaximum(const PacketScene& scene, const VolumeSampler<AnyVoxels>& sampler,
                                const Rays& rays, VF first, VF last) {
    const VF one = set(1.0f), zero = hn::Zero(f);
    VF greatest = set(-32768.0f), n = first;
    MF active = hn::Le(n, last);
    while (any(active)) {
        const V3 place = along(rays.origin, n, rays.step);
        const Blocks blocks = blocksAt(scene, place);
        const MF empty = hn::Gt(blocks.distance, zero);
        VF advance = one;
        if (any(hn::And(active, empty)))
            advance = hn::IfThenElse(empty, stepsToLeave(rays, place, blocks), one);
        const MF looking = hn::AndNot(empty, active);
        if (any(looking))
            greatest = hn::Max(
                greatest,
                hn::IfThenElse(looking, sampler.value(onlyWhere(looking, place)), greatest));
        n = hn::Add(n, hn::IfThenElseZero(active, advance));
        active =
            hn::And(active, hn::And(hn::Le(n, last), hn::Lt(greatest, set(scene.lastVisibleHu))));
    }
    const Color here = classified(scene, greatest);
    const VF opacity = hn::IfThenElseZero(mayShow(scene, greatest), here.a);
    return {hn::Mul(here.r, opacity), hn::Mul(here.g, opacity), hn::Mul(here.b, opacity), opacity};
}

/// The place where opacity first is enough, found between samples by bisection.
template <class AnyVoxels>
HWY_NOINLINE Color marchFirstHit(const PacketScene& scene, const VolumeSampler<AnyVoxels>& sampler,
                                 const Rays& rays, VF first, VF last) {
    constexpr int bisections = 8;
    const VF one = set(1.0f), zero = hn::Zero(f), half = set(0.5f);
    const VF enough = set(scene.u.firstHitOpacity);
    VF n = first, hit = first;
    MF active = hn::Le(n, last), ended = hn::Lt(one, zero);
    for (bool again = false; any(active); again = true) {
        const Search at = searched(scene, sampler, rays, n, last, active, again);
        if (!any(at.found)) break;
        const MF opaque = hn::And(at.found, hn::Ge(classified(scene, at.hu).a, enough));
        hit = hn::IfThenElse(opaque, at.n, hit);
        ended = hn::Or(ended, opaque);
        n = hn::Add(at.n, one);
        active = hn::And(hn::AndNot(opaque, at.found), hn::Le(n, last));
    }
    if (!any(ended)) return {zero, zero, zero, zero};
    // The first sample has nothing before it to bisect.
    VF before = hn::Max(hn::Sub(hit, one), first);
    const auto placeAt = [&](VF at) HWY_ATTR {
        return onlyWhere(ended, along(rays.origin, at, rays.step));
    };
    for (int count = 0; count < bisections; ++count) {
        const VF middle = hn::Mul(half, hn::Add(before, hit));
        const MF beyond = hn::Ge(classified(scene, sampler.value(placeAt(middle))).a, enough);
        hit = hn::IfThenElse(beyond, middle, hit);
        before = hn::IfThenElse(beyond, before, middle);
    }
    const V3 place = placeAt(hit);
    Color color = classified(scene, sampler.value(place));
    if (scene.shading)
        color = shaded(scene, color, normalOf(scene, sampler.gradient(place, ended)), rays.lightMm,
                       hit);
    return {hn::IfThenElseZero(ended, color.r), hn::IfThenElseZero(ended, color.g),
            hn::IfThenElseZero(ended, color.b), hn::IfThenElseZero(ended, one)};
}

/// By the scene's composition.
template <class AnyVoxels>
HWY_INLINE Color march(const PacketScene& scene, const VolumeSampler<AnyVoxels>& sampler,
                       const Rays& rays, VF first, VF last) {
    switch (scene.composition) {
        case Composition::maximumIntensity:
            return marchMaximum(scene, sampler, rays, first, last);
        case Composition::firstHit:
            return marchFirstHit(scene, sampler, rays, first, last);
        default:
            if (scene.integrals) return marchSegments(scene, sampler, rays, first, last);
            return scene.rows > 1 ? marchSamples<true>(scene, sampler, rays, first, last)
                                  : marchSamples<false>(scene, sampler, rays, first, last);
    }
}

/// What rays' pixels show, bytes of sRGB: their sums, before the linear light that comes from
/// behind.
struct Bytes {
    std::int32_t r[lanes], g[lanes], b[lanes];
};
HWY_MAYBE_UNUSED static HWY_NOINLINE void pixelColors(const PacketScene& scene, const Color& sum,
                                                      const Color& backdrop, Bytes& bytes) {
    const VF through = hn::Sub(set(1.0f), sum.a);
    // A ray that was ended early counts as opaque, or its pixel would be darker than its
    // neighbours.
    const MF ended = scene.composition == Composition::maximumIntensity
                         ? hn::Lt(set(1.0f), hn::Zero(f))
                         : hn::Ge(sum.a, set(scene.u.terminationOpacity));
    const VF scale = hn::Div(set(1.0f), hn::Max(sum.a, set(1e-6f)));
    const auto shown = [&](VF color, VF behindIt) HWY_ATTR {
        return displayed(
            hn::IfThenElse(ended, hn::Mul(color, scale), hn::MulAdd(through, behindIt, color)));
    };
    hn::StoreU(shown(sum.r, backdrop.r), i, bytes.r);
    hn::StoreU(shown(sum.g, backdrop.g), i, bytes.g);
    hn::StoreU(shown(sum.b, backdrop.b), i, bytes.b);
}

/// Into a picture `width` pixels wide, whose rows [firstRow, endRow) are drawn.
HWY_INLINE void storePixels(std::uint8_t* rgb, int width, int firstRow, int endRow,
                            const Bytes& bytes, int left, int top) {
    for (int lane = 0; lane < lanes; ++lane) {
        const int x = left + lane % packetWidth, y = top + lane / packetWidth;
        if (x >= width || y < firstRow || y >= endRow) continue;
        std::uint8_t* pixel = rgb + 3 * (std::int64_t(y) * width + x);
        pixel[0] = std::uint8_t(bytes.r[lane]);
        pixel[1] = std::uint8_t(bytes.g[lane]);
        pixel[2] = std::uint8_t(bytes.b[lane]);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace haustra::render
HWY_AFTER_NAMESPACE();
#endif
