// Where the colon's segments lie along its centerline.
#pragma once

#include "core/centerline.h"
#include "core/colon_record.h"

#include <optional>
#include <vector>

namespace haustra {

/// From this arc on the centerline is in the segment, to the next start; what lies before the first
/// start is in its segment, too.
struct SegmentStart {
    double arcMm = 0.0;
    ColonSegment segment = ColonSegment::rectum;
};

/// Each piece lies where the centerline passes nearest to its middle; a border is half-way between
/// pieces of two segments. Where loops touch, the nearest sample may be another loop's: pieces that
/// are out of order, the fewest that leave the others in order, tell nothing. In the order of the
/// arcs; none without pieces or centerline. O(pieces · samples).
std::vector<SegmentStart> segmentsAlong(const Centerline& centerline,
                                        const std::vector<ColonPiece>& pieces);

/// None where there are no starts.
std::optional<ColonSegment> segmentAt(const std::vector<SegmentStart>& starts, double arcMm);

}  // namespace haustra
