// The optical model (render/optics/optics.h) for a packet of samples or segments:
// shaders/optics.glsl in vectors, with values in HU and normals in HU differences.
#if defined(HAUSTRA_OPTICS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAUSTRA_OPTICS_INL_H
#undef HAUSTRA_OPTICS_INL_H
#else
#define HAUSTRA_OPTICS_INL_H
#endif

#include "render/native/packets.h"
#include "render/native/volume_sampler-inl.h"
#include "render/optics/transfer_table.h"

HWY_BEFORE_NAMESPACE();
namespace haustra::render {
namespace HWY_NAMESPACE {

/// Four floats of each ray side by side: part k has those of rays k, k + 4, …, in blocks of four,
/// which vector units load and shuffle cheaply; gathering float by float takes four times as long.
/// Where a packet is one ray, part k is its channel k.
struct Rows {
    VF part[4];
};
struct Channels {
    VF c[4];
};

#if HWY_TARGET == HWY_SCALAR

/// Rows `numbers` of a table.
HWY_INLINE Rows loadedRows(const float* table, VI numbers) {
    const float* row = table + 4 * std::ptrdiff_t(hn::GetLane(numbers));
    return {{set(row[0]), set(row[1]), set(row[2]), set(row[3])}};
}
/// The same row for all rays.
HWY_INLINE Rows sameRow(const float* row) {
    return {{set(row[0]), set(row[1]), set(row[2]), set(row[3])}};
}
/// One number of each ray, four times.
HWY_INLINE Rows spread(VF values) {
    return {{values, values, values, values}};
}
HWY_INLINE Channels channelsOf(const Rows& rows) {
    return {{rows.part[0], rows.part[1], rows.part[2], rows.part[3]}};
}

#else

/// Every fourth of the rows numbers[0], numbers[4], …
template <class D>
HWY_INLINE hn::Vec<D> everyFourth(D d, const float* table, const std::int32_t* numbers) {
    if constexpr (hn::MaxLanes(D()) == 4) {
        return hn::LoadU(d, table + 4 * std::ptrdiff_t(numbers[0]));
    } else {
        constexpr std::size_t upper = hn::MaxLanes(D()) / 2;
        const hn::Half<D> half;
        return hn::Combine(d, everyFourth(half, table, numbers + upper),
                           everyFourth(half, table, numbers));
    }
}
/// Rows `numbers` of a table.
HWY_INLINE Rows loadedRows(const float* table, VI numbers) {
    HWY_ALIGN std::int32_t stored[lanes];
    hn::Store(numbers, i, stored);
    return {{everyFourth(f, table, stored), everyFourth(f, table, stored + 1),
             everyFourth(f, table, stored + 2), everyFourth(f, table, stored + 3)}};
}
/// The same row for all rays.
HWY_INLINE Rows sameRow(const float* row) {
    const VF all = hn::LoadDup128(f, row);
    return {{all, all, all, all}};
}
/// One number of each ray, four times.
HWY_INLINE Rows spread(VF values) {
    return {{hn::Broadcast<0>(values), hn::Broadcast<1>(values), hn::Broadcast<2>(values),
             hn::Broadcast<3>(values)}};
}
HWY_INLINE Channels channelsOf(const Rows& rows) {
    const hn::Repartition<double, F> pairs;
    const VF low01 = hn::InterleaveLower(f, rows.part[0], rows.part[1]);
    const VF high01 = hn::InterleaveUpper(f, rows.part[0], rows.part[1]);
    const VF low23 = hn::InterleaveLower(f, rows.part[2], rows.part[3]);
    const VF high23 = hn::InterleaveUpper(f, rows.part[2], rows.part[3]);
    const auto lower = [&](VF a, VF b) HWY_ATTR {
        return hn::BitCast(
            f, hn::InterleaveLower(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
    };
    const auto upper = [&](VF a, VF b) HWY_ATTR {
        return hn::BitCast(
            f, hn::InterleaveUpper(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
    };
    return {
        {lower(low01, low23), upper(low01, low23), lower(high01, high23), upper(high01, high23)}};
}

#endif

/// An operation on the parts, one by one.
template <class Operation, class... More>
HWY_INLINE Rows each(Operation operation, const More&... rows) {
    return {{operation(rows.part[0]...), operation(rows.part[1]...), operation(rows.part[2]...),
             operation(rows.part[3]...)}};
}

struct Color {
    VF r, g, b, a;
};

HWY_INLINE Color mix(const Color& a, const Color& b, VF share) {
    return {mix(a.r, b.r, share), mix(a.g, b.g, share), mix(a.b, b.b, share), mix(a.a, b.a, share)};
}

/// Entries of a table of four floats each, and how far between it and the next.
struct Entry {
    VI number;
    VF share;
};
HWY_INLINE Entry entryAt(VF at) {
    constexpr float last = float(TransferTable::entries - 1);
    const VF inside = clamped(at, 0.0f, last);
    const VF low = hn::Min(hn::Floor(inside), set(last - 1.0f));
    return {hn::ConvertTo(i, low), hn::Sub(inside, low)};
}
/// What lies between an entry's row and the next.
HWY_INLINE Rows rowsAt(const float* table, const Entry& entry) {
    return each([](VF low, VF high, VF share) HWY_ATTR { return mix(low, high, share); },
                loadedRows(table, entry.number), loadedRows(table + 4, entry.number),
                spread(entry.share));
}
HWY_INLINE Color lookedUp(const float* table, const Entry& entry) {
    const Channels channels = channelsOf(rowsAt(table, entry));
    return {channels.c[0], channels.c[1], channels.c[2], channels.c[3]};
}

/// HU to entries of the table, not clamped.
HWY_INLINE VF entryOf(const PacketScene& scene, VF hu) {
    return hn::MulAdd(hu, set(scene.entriesPerHu), set(scene.firstEntry));
}

/// Colour and opacity of samples by a 1-D transfer function.
HWY_INLINE Color classified(const PacketScene& scene, VF hu) {
    return lookedUp(scene.table, entryAt(entryOf(scene, hu)));
}
/// By a 2-D one; its row by the gradient magnitude, as long as the normal.
HWY_INLINE Color classified(const PacketScene& scene, VF hu, VF gradientMagnitude) {
    const float last = float(scene.rows - 1);
    const VF row = clamped(hn::Mul(gradientMagnitude, set(scene.rowsPerGradient)), 0.0f, last);
    const VF low = hn::Min(hn::Floor(row), set(last - 1.0f));
    const VI rowEntries = hn::Set(i, TransferTable::entries);
    const Entry entry = entryAt(entryOf(scene, hu));
    const VI first = hn::Add(hn::Mul(hn::ConvertTo(i, low), rowEntries), entry.number);
    return mix(lookedUp(scene.table, {first, entry.share}),
               lookedUp(scene.table, {hn::Add(first, rowEntries), entry.share}), hn::Sub(row, low));
}

/// The integral up to entries; beyond the table its ends go on.
HWY_INLINE Rows integralTo(const PacketScene& scene, VF entry) {
    const Rows within = rowsAt(scene.integrals, entryAt(entry));
    const VF under = hn::Min(entry, hn::Zero(f));
    const VF over = hn::Max(hn::Sub(entry, set(float(TransferTable::entries - 1))), hn::Zero(f));
    if (hn::AllTrue(f, hn::Eq(under, over))) return within;  // both 0
    const auto onward = [](VF sum, VF steps, VF growth)
                            HWY_ATTR { return hn::MulAdd(steps, growth, sum); };
    return each(onward, each(onward, within, spread(over), sameRow(&scene.u.integralAbove.x)),
                spread(under), sameRow(&scene.u.integralBelow.x));
}

/// Colour and opacity of segments between two samples [Engel et al. 2001].
HWY_INLINE Color classifiedSegment(const PacketScene& scene, VF front, VF back) {
    const VF a = entryOf(scene, front), b = entryOf(scene, back);
    const VF half = set(0.5f), one = set(1.0f);
    const VF middle = hn::Mul(half, hn::Add(a, b));
    // Values closer than an entry count as an entry apart, lest their difference drown in rounding.
    const VF reach = hn::Mul(half, hn::Max(hn::AbsDiff(b, a), one));
    const Channels between = channelsOf(
        each([](VF to, VF from) HWY_ATTR { return hn::Max(hn::Sub(to, from), hn::Zero(f)); },
             integralTo(scene, hn::Add(middle, reach)), integralTo(scene, hn::Sub(middle, reach))));
    const VF depth = between.c[3], perDepth = hn::Div(one, hn::Max(depth, set(1e-20f)));
    const VF passing = hn::Exp(f, hn::Neg(hn::Div(depth, hn::Add(reach, reach))));
    return {hn::Mul(between.c[0], perDepth), hn::Mul(between.c[1], perDepth),
            hn::Mul(between.c[2], perDepth), hn::Sub(one, passing)};
}

/// Whether values may be visible, or first hit; of a 2-D table, at some gradient.
HWY_INLINE MF mayShow(const PacketScene& scene, VF hu) {
    return hn::And(hn::Gt(hu, set(scene.visibleAboveHu)), hn::Lt(hu, set(scene.visibleBelowHu)));
}
/// The same of segments.
HWY_INLINE MF mayShow(const PacketScene& scene, VF front, VF back) {
    return hn::And(hn::Gt(hn::Max(front, back), set(scene.visibleAboveHu)),
                   hn::Lt(hn::Min(front, back), set(scene.visibleBelowHu)));
}

/// Differences over two voxels, in the patient: a gradient transforms by the inverse transpose of
/// patientFromVoxel. Twice as long as the gradient, HU a millimetre.
HWY_INLINE V3 normalOf(const PacketScene& scene, V3 gradient) {
    const auto component = [&](int axis) HWY_ATTR {
        return hn::MulAdd(gradient.x, set(scene.voxelFromMm[0][axis]),
                          hn::MulAdd(gradient.y, set(scene.voxelFromMm[1][axis]),
                                     hn::Mul(gradient.z, set(scene.voxelFromMm[2][axis]))));
    };
    return {component(0), component(1), component(2)};
}

/// max(mirror, 0) to the power of the shininess, which is whole as a rule.
HWY_INLINE VF glossOf(VF mirror, float shininess) {
    if (shininess != float(int(shininess)) || shininess < 1.0f || shininess > 1024.0f)
        return power(mirror, set(shininess));
    VF square = hn::Max(mirror, hn::Zero(f)), gloss = set(1.0f);
    for (int rest = int(shininess); rest > 0; rest >>= 1) {
        if (rest & 1) gloss = hn::Mul(gloss, square);
        square = hn::Mul(square, square);
    }
    return gloss;
}

/// A lamp, seen from where it hangs, `n` steps away; colours are linear light, `lightMm` is unit.
HWY_INLINE Color shaded(const PacketScene& scene, const Color& color, V3 normal, V3 lightMm, VF n) {
    const VF squared = dot(normal, normal), one = set(1.0f);
    // Both faces are lit. Where the volume is flat there is no surface, and nothing to shade.
    const VF least = set(4e-11f);
    const MF steep = hn::Gt(squared, least);
    const VF facing = hn::IfThenElse(
        steep, hn::Div(hn::Abs(dot(normal, lightMm)), hn::Sqrt(hn::Max(squared, least))), one);
    const shaders::MarchUniforms& u = scene.u;
    const VF depth = hn::Mul(n, set(u.stepMm / u.lightHalvesMm));
    const VF falloff = hn::Div(one, hn::MulAdd(depth, depth, one));
    const VF mirror = hn::MulSub(hn::Add(facing, facing), facing, one);
    const VF highlight =
        hn::IfThenElseZero(steep, hn::Mul(set(u.specular), glossOf(mirror, u.shininess)));
    const VF matt = hn::MulAdd(set(u.diffuse), facing, set(u.ambient));
    const auto lit = [&](VF c)
                         HWY_ATTR { return hn::Mul(falloff, hn::MulAdd(c, matt, highlight)); };
    return {lit(color.r), lit(color.g), lit(color.b), color.a};
}

/// Front to back, equation 5.1: `sum` with what lies behind it, where `wanted`.
HWY_INLINE Color behind(const Color& sum, const Color& here, MF wanted) {
    const VF share = hn::IfThenElseZero(wanted, hn::Mul(hn::Sub(set(1.0f), sum.a), here.a));
    return {hn::MulAdd(share, here.r, sum.r), hn::MulAdd(share, here.g, sum.g),
            hn::MulAdd(share, here.b, sum.b), hn::Add(sum.a, share)};
}

/// sRGB's transfer curve (IEC 61966-2-1), 0…255.
HWY_INLINE VI displayed(VF linear) {
    const VF c = clamped(linear, 0.0f, 1.0f);
    const VF curved = hn::MulSub(set(1.055f), power(c, set(1.0f / 2.4f)), set(0.055f));
    const VF value = hn::IfThenElse(hn::Gt(c, set(0.0031308f)), curved, hn::Mul(c, set(12.92f)));
    return hn::NearestInt(hn::Mul(value, set(255.0f)));
}

}  // namespace HWY_NAMESPACE
}  // namespace haustra::render
HWY_AFTER_NAMESPACE();
#endif
