#include "core/segments_along.h"

#include <algorithm>

namespace haustra {
namespace {

// Which numbers make the longest subsequence that does not fall.
std::vector<std::size_t> longestInOrder(const std::vector<double>& numbers) {
    constexpr std::size_t none = ~std::size_t(0);
    std::vector<std::size_t> lastOfLength;  // the least that ends a subsequence of each length
    std::vector<std::size_t> before(numbers.size(), none);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        const auto at = std::ranges::upper_bound(lastOfLength, numbers[n], {},
                                                 [&](std::size_t m) { return numbers[m]; });
        if (at != lastOfLength.begin()) before[n] = at[-1];
        if (at == lastOfLength.end())
            lastOfLength.push_back(n);
        else
            *at = n;
    }
    std::vector<std::size_t> kept;
    for (std::size_t n = lastOfLength.empty() ? none : lastOfLength.back(); n != none;
         n = before[n])
        kept.push_back(n);
    std::ranges::reverse(kept);
    return kept;
}

}  // namespace

std::vector<SegmentStart> segmentsAlong(const Centerline& centerline,
                                        const std::vector<ColonPiece>& pieces) {
    if (centerline.points.empty()) return {};
    std::vector<double> arcsMm;
    for (const ColonPiece& piece : pieces)
        arcsMm.push_back(nearestArc(centerline, piece.centerMm));
    std::vector<SegmentStart> starts;
    double lastMm = 0.0;
    for (const std::size_t n : longestInOrder(arcsMm)) {
        const ColonSegment segment = segmentOf(pieces[n].part);
        if (starts.empty())
            starts.push_back({0.0, segment});
        else if (starts.back().segment != segment)
            starts.push_back({0.5 * (lastMm + arcsMm[n]), segment});
        lastMm = arcsMm[n];
    }
    return starts;
}

std::optional<ColonSegment> segmentAt(const std::vector<SegmentStart>& starts, double arcMm) {
    if (starts.empty()) return std::nullopt;
    const auto after = std::ranges::upper_bound(starts, arcMm, {}, &SegmentStart::arcMm);
    return after == starts.begin() ? starts.front().segment : after[-1].segment;
}

}  // namespace haustra
