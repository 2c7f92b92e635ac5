// Rows of four floats, one for each ray of a packet, as they come from a table and as vectors of
// one channel each.
#if defined(HAUSTRA_TABLE_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAUSTRA_TABLE_ROWS_INL_H
#undef HAUSTRA_TABLE_ROWS_INL_H
#else
#define HAUSTRA_TABLE_ROWS_INL_H
#endif

#include "render/native/volume_sampler-inl.h"

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

}  // namespace HWY_NAMESPACE
}  // namespace haustra::render
HWY_AFTER_NAMESPACE();
#endif
