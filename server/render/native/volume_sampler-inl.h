// Vectors of one value for each ray of a packet, and the volume as they sample it. Included once
// for each vector unit that is compiled for (Highway's dynamic dispatch).
#if defined(HAUSTRA_VOLUME_SAMPLER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAUSTRA_VOLUME_SAMPLER_INL_H
#undef HAUSTRA_VOLUME_SAMPLER_INL_H
#else
#define HAUSTRA_VOLUME_SAMPLER_INL_H
#endif

#include "render/native/packets.h"

#include <cstring>

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace haustra::render {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;
using MF = hn::Mask<F>;
constexpr F f;
constexpr I i;

// Pixels of a packet: neighbouring rays share their loops and their voxels.
constexpr int lanes = int(hn::MaxLanes(f));
constexpr int packetWidth = lanes >= 8 ? 4 : lanes >= 2 ? 2 : 1;
constexpr int packetHeight = lanes / packetWidth;

/// Offsets of a packet's pixels.
HWY_INLINE VF laneX() {
    return hn::ConvertTo(f, hn::And(hn::Iota(i, 0), hn::Set(i, packetWidth - 1)));
}
HWY_INLINE VF laneY() {
    constexpr int shift = packetWidth == 4 ? 2 : packetWidth == 2 ? 1 : 0;
    return hn::ConvertTo(f, hn::ShiftRight<shift>(hn::Iota(i, 0)));
}

struct V3 {
    VF x, y, z;
};

HWY_INLINE VF set(float value) {
    return hn::Set(f, value);
}
HWY_INLINE VF dot(V3 a, V3 b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE VF dot(const float* row, V3 v) {
    return hn::MulAdd(set(row[0]), v.x, hn::MulAdd(set(row[1]), v.y, hn::Mul(set(row[2]), v.z)));
}
HWY_INLINE V3 scaled(V3 v, VF by) {
    return {hn::Mul(v.x, by), hn::Mul(v.y, by), hn::Mul(v.z, by)};
}
HWY_INLINE V3 along(V3 origin, VF n, V3 step) {
    return {hn::MulAdd(n, step.x, origin.x), hn::MulAdd(n, step.y, origin.y),
            hn::MulAdd(n, step.z, origin.z)};
}
HWY_INLINE VF mix(VF a, VF b, VF share) {
    return hn::MulAdd(share, hn::Sub(b, a), a);
}
HWY_INLINE VF least(V3 v) {
    return hn::Min(v.x, hn::Min(v.y, v.z));
}
HWY_INLINE VF most(V3 v) {
    return hn::Max(v.x, hn::Max(v.y, v.z));
}
// What is not a number becomes the lower bound: x86 takes the second operand then.
HWY_INLINE VF clamped(VF value, float low, float high) {
    return hn::Min(hn::Max(value, set(low)), set(high));
}
HWY_INLINE bool any(MF mask) {
    return !hn::AllFalse(f, mask);
}
HWY_INLINE VF reciprocalOrLarge(VF v) {
    return hn::Div(set(1.0f), hn::IfThenElse(hn::Eq(v, hn::Zero(f)), set(1e-12f), v));
}
HWY_INLINE VF power(VF base, VF exponent) {
    const VF raised = hn::Exp(f, hn::Mul(exponent, hn::Log(f, hn::Max(base, set(1e-30f)))));
    return hn::IfThenElseZero(hn::Gt(base, hn::Zero(f)), raised);
}

/// Neighbours along x, as one gather brings them.
struct Pair {
    VI low, high;
};
HWY_INLINE Pair split(VI both) {
    return {hn::ShiftRight<16>(hn::ShiftLeft<16>(both)), hn::ShiftRight<16>(both)};
}
HWY_INLINE VF between(Pair pair, VF share) {
    return hn::MulAdd(share, hn::ConvertTo(f, hn::Sub(pair.high, pair.low)),
                      hn::ConvertTo(f, pair.low));
}

/// Voxels of a volume of less than 4 GiB, by 32-bit byte offsets from its middle.
struct NearVoxels {
    struct Place {
        VI bytes;
    };
    const std::int32_t* base;
    VI row, slice;

    explicit HWY_INLINE NearVoxels(const PacketScene& scene)
        : base(reinterpret_cast<const std::int32_t*>(
              reinterpret_cast<std::uintptr_t>(scene.voxels) + 0x80000000u)),
          row(hn::Set(i, std::int32_t(scene.rowStride))),
          slice(hn::Set(i, std::int32_t(scene.sliceStride))) {}
    HWY_INLINE Place at(VI x, VI y, VI z) const {
        const VI voxel = hn::Add(x, hn::Add(hn::Mul(y, row), hn::Mul(z, slice)));
        return {hn::Xor(hn::ShiftLeft<1>(voxel), hn::Set(i, std::int32_t(0x80000000u)))};
    }
    HWY_INLINE Pair pair(Place place, std::int64_t further) const {
        return split(
            hn::GatherOffset(i, base, hn::Add(place.bytes, hn::Set(i, std::int32_t(2 * further)))));
    }
};

/// Voxels of any volume, one by one.
struct FarVoxels {
    struct Place {
        std::int64_t voxel[lanes];
    };
    const PacketScene& scene;

    explicit HWY_INLINE FarVoxels(const PacketScene& s) : scene(s) {}
    HWY_INLINE Place at(VI x, VI y, VI z) const {
        HWY_ALIGN std::int32_t xs[lanes], ys[lanes], zs[lanes];
        hn::Store(x, i, xs), hn::Store(y, i, ys), hn::Store(z, i, zs);
        Place place;
        for (int lane = 0; lane < lanes; ++lane)
            place.voxel[lane] =
                xs[lane] + ys[lane] * scene.rowStride + zs[lane] * scene.sliceStride;
        return place;
    }
    HWY_INLINE Pair pair(const Place& place, std::int64_t further) const {
        HWY_ALIGN std::int32_t both[lanes];
        for (int lane = 0; lane < lanes; ++lane)
            std::memcpy(&both[lane], scene.voxels + place.voxel[lane] + further, 4);
        return split(hn::Load(i, both));
    }
};

/// Trilinear interpolation in the volume; outside the outermost voxel centres their value goes on.
template <class AnyVoxels>
struct VolumeSampler {
    AnyVoxels voxels;
    std::int64_t row, slice;  // 0 across a volume that is one voxel thick
    float last[3];            // centres
    float lastLow[3];         // highest lower corner of a cell

    explicit HWY_INLINE VolumeSampler(const PacketScene& scene)
        : voxels(scene),
          row(scene.size[1] > 1 ? scene.rowStride : 0),
          slice(scene.size[2] > 1 ? scene.sliceStride : 0) {
        for (int axis = 0; axis < 3; ++axis) {
            last[axis] = float(scene.size[axis] - 1);
            lastLow[axis] = float(scene.size[axis] > 1 ? scene.size[axis] - 2 : 0);
        }
    }

    /// The cell around a place, and the place in it.
    struct Cell {
        typename AnyVoxels::Place low;
        V3 share;
    };
    HWY_INLINE Cell cellAt(V3 place) const {
        const V3 inside{clamped(place.x, 0.0f, last[0]), clamped(place.y, 0.0f, last[1]),
                        clamped(place.z, 0.0f, last[2])};
        const V3 low{hn::Min(hn::Floor(inside.x), set(lastLow[0])),
                     hn::Min(hn::Floor(inside.y), set(lastLow[1])),
                     hn::Min(hn::Floor(inside.z), set(lastLow[2]))};
        return {
            voxels.at(hn::ConvertTo(i, low.x), hn::ConvertTo(i, low.y), hn::ConvertTo(i, low.z)),
            {hn::Sub(inside.x, low.x), hn::Sub(inside.y, low.y), hn::Sub(inside.z, low.z)}};
    }
    HWY_INLINE VF alongX(const Cell& cell, std::int64_t further) const {
        return between(voxels.pair(cell.low, further), cell.share.x);
    }
    HWY_INLINE VF valueIn(const Cell& cell) const {
        return mix(mix(alongX(cell, 0), alongX(cell, row), cell.share.y),
                   mix(alongX(cell, slice), alongX(cell, row + slice), cell.share.y), cell.share.z);
    }
    HWY_INLINE VF value(V3 place) const { return valueIn(cellAt(place)); }

    /// Differences of the values a voxel ahead and a voxel behind.
    HWY_NOINLINE V3 gradient(V3 place, MF wanted) const {
        const MF inner = hn::And(
            hn::And(hn::Ge(least(place), set(1.0f)), hn::Lt(place.x, set(last[0] - 1.0f))),
            hn::And(hn::Lt(place.y, set(last[1] - 1.0f)), hn::Lt(place.z, set(last[2] - 1.0f))));
        if (hn::AllTrue(f, hn::Or(inner, hn::Not(wanted)))) {
            // What is not wanted must not read beyond the volume.
            const VF one = set(1.0f);
            return innerGradient(
                cellAt({hn::IfThenElse(inner, place.x, one), hn::IfThenElse(inner, place.y, one),
                        hn::IfThenElse(inner, place.z, one)}));
        }
        V3 result = plainGradient(place);
        if (any(inner) && last[0] >= 3.0f && last[1] >= 3.0f && last[2] >= 3.0f) {
            // The same to the bit as in a packet that lies inside as a whole.
            const VF one = set(1.0f);
            const V3 there = innerGradient(
                cellAt({hn::IfThenElse(inner, place.x, one), hn::IfThenElse(inner, place.y, one),
                        hn::IfThenElse(inner, place.z, one)}));
            result = {hn::IfThenElse(inner, there.x, result.x),
                      hn::IfThenElse(inner, there.y, result.y),
                      hn::IfThenElse(inner, there.z, result.z)};
        }
        return result;
    }
    HWY_NOINLINE V3 plainGradient(V3 p) const {
        const VF one = set(1.0f);
        const auto difference = [&](V3 ahead, V3 behind)
                                    HWY_ATTR { return hn::Sub(value(ahead), value(behind)); };
        return {difference({hn::Add(p.x, one), p.y, p.z}, {hn::Sub(p.x, one), p.y, p.z}),
                difference({p.x, hn::Add(p.y, one), p.z}, {p.x, hn::Sub(p.y, one), p.z}),
                difference({p.x, p.y, hn::Add(p.z, one)}, {p.x, p.y, hn::Sub(p.z, one)})};
    }
    // The six samples lie in cells that share voxels: 16 pairs of them in place of 24.
    HWY_NOINLINE V3 innerGradient(const Cell& cell) const {
        const VF sx = cell.share.x, sy = cell.share.y, sz = cell.share.z;
        VF across[4], middle[4];  // of the cell's four rows
        for (int line = 0; line < 4; ++line) {
            const std::int64_t at = (line & 1) * row + (line >> 1) * slice;
            const Pair before = voxels.pair(cell.low, at - 1),
                       after = voxels.pair(cell.low, at + 1);
            const VF d0 = hn::ConvertTo(f, hn::Sub(after.low, before.low));
            const VF d1 = hn::ConvertTo(f, hn::Sub(after.high, before.high));
            across[line] = mix(d0, d1, sx);
            middle[line] = between({before.high, after.low}, sx);
        }
        const VF behindY0 = alongX(cell, -row), behindY1 = alongX(cell, slice - row);
        const VF aheadY0 = alongX(cell, 2 * row), aheadY1 = alongX(cell, slice + 2 * row);
        const VF behindZ0 = alongX(cell, -slice), behindZ1 = alongX(cell, row - slice);
        const VF aheadZ0 = alongX(cell, 2 * slice), aheadZ1 = alongX(cell, row + 2 * slice);
        const VF y0 = mix(hn::Sub(middle[1], behindY0), hn::Sub(aheadY0, middle[0]), sy);
        const VF y1 = mix(hn::Sub(middle[3], behindY1), hn::Sub(aheadY1, middle[2]), sy);
        const VF z0 = mix(hn::Sub(middle[2], behindZ0), hn::Sub(aheadZ0, middle[0]), sz);
        const VF z1 = mix(hn::Sub(middle[3], behindZ1), hn::Sub(aheadZ1, middle[1]), sz);
        return {mix(mix(across[0], across[1], sy), mix(across[2], across[3], sy), sz),
                mix(y0, y1, sz), mix(z0, z1, sy)};
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace haustra::render
HWY_AFTER_NAMESPACE();
#endif
