#include "render/native/packets.h"

// This text is compiled once for each vector unit, by an include that must come before others.
// clang-format off
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/native/slice_packets.cpp"
#include <hwy/foreach_target.h>
#include "render/native/march-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace haustra::render {
namespace HWY_NAMESPACE {

namespace {

// Of the samples along the normal that lie in the volume; `met` is where there is one.
template <class AnyVoxels, class IsInside>
VF slabValue(const VolumeSampler<AnyVoxels>& sampler, const PacketSlice& slice, V3 middle,
             const IsInside& isInside, MF& met) {
    const V3 step{set(slice.along.x), set(slice.along.y), set(slice.along.z)};
    VF sum = hn::Zero(f), count = hn::Zero(f), most = set(-1e9f);
    for (int n = -slice.samplesAside; n <= slice.samplesAside; ++n) {
        const V3 place = along(middle, set(float(n)), step);
        const MF inside = isInside(place);
        if (!any(inside)) continue;
        const VF hu = sampler.value(onlyWhere(inside, place));
        sum = hn::Add(sum, hn::IfThenElseZero(inside, hu));
        count = hn::Add(count, hn::IfThenElseZero(inside, set(1.0f)));
        most = hn::IfThenElse(inside, hn::Max(most, hu), most);
    }
    met = hn::Gt(count, hn::Zero(f));
    return slice.maximum ? most : hn::Div(sum, hn::Max(count, set(1.0f)));
}

template <class AnyVoxels>
void drawRows(const PacketScene& scene, const PacketSlice& slice, int firstRow, int endRow,
              std::uint8_t* rgb) {
    const VolumeSampler<AnyVoxels> sampler(scene);
    const auto vector = [&](glm::vec3 v) HWY_ATTR { return V3{set(v.x), set(v.y), set(v.z)}; };
    const V3 origin = vector(slice.origin), right = vector(slice.right), down = vector(slice.down);
    for (int top = firstRow; top < endRow; top += packetHeight) {
        for (int left = 0; left < slice.width; left += packetWidth) {
            const V3 place = along(along(origin, hn::Add(laneX(), set(float(left))), right),
                                   hn::Add(laneY(), set(float(slice.firstRow + top))), down);
            const auto within = [&](VF p, int axis) HWY_ATTR {
                return hn::And(hn::Ge(p, set(-0.5f)),
                               hn::Le(p, set(float(scene.size[axis]) - 0.5f)));
            };
            const auto isInside = [&](V3 p) HWY_ATTR {
                return hn::And(within(p.x, 0), hn::And(within(p.y, 1), within(p.z, 2)));
            };
            MF inside = isInside(place);
            VF hu = hn::Zero(f);
            if (slice.samplesAside > 0)
                hu = slabValue(sampler, slice, place, isInside, inside);
            else if (any(inside))
                hu = sampler.value(onlyWhere(inside, place));
            Bytes bytes{};
            if (any(inside)) {
                const VF grey =
                    clamped(hn::MulAdd(hu, set(slice.perHu), set(slice.atZero)), 0.0f, 1.0f);
                hn::StoreU(hn::NearestInt(hn::IfThenElseZero(inside, hn::Mul(grey, set(255.0f)))),
                           i, bytes.r);
                for (int lane = 0; lane < lanes; ++lane)
                    bytes.g[lane] = bytes.b[lane] = bytes.r[lane];
            }
            storePixels(rgb, slice.width, firstRow, endRow, bytes, left, top);
        }
    }
}

void drawSlice(const PacketScene& scene, const PacketSlice& slice, int firstRow, int endRow,
               std::uint8_t* rgb) {
    if (scene.isFar()) return drawRows<FarVoxels>(scene, slice, firstRow, endRow, rgb);
    drawRows<NearVoxels>(scene, slice, firstRow, endRow, rgb);
}

DrawSlice drawer() {
    return drawSlice;
}

}  // namespace

}  // namespace HWY_NAMESPACE
}  // namespace haustra::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace haustra::render {

HWY_EXPORT(drawer);

DrawSlice slicePackets() {
    return HWY_DYNAMIC_DISPATCH(drawer)();
}

}  // namespace haustra::render
#endif
