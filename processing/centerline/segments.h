// The segments of the lumen that a centerline visits, with their ends and the route along each.
#pragma once

#include "centerline/graph.h"
#include "centerline/search.h"
#include "core/result.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace haustra::centerline {

/// Which end of which segment the centerline begins at.
enum class EndRule {
    rectumToCecum,  ///< the colon's anatomy, through all segments worth a visit (orderSegments)
    farthest,       ///< the largest segment's longest path, from its lower end (towards the feet)
};

/// The ends that a person chose, as nodes.
struct GivenEnds {
    std::optional<std::int32_t> first, last;
};

/// One segment in the direction of travel.
struct Segment {
    std::vector<std::int32_t> route;  ///< nodes
    PathTree widest;                  ///< the segment's widest tree, from the route's first node
    bool firstGiven = false, lastGiven = false;
};

/// The node nearest to a point that a person gave, if any. Fails (badInput) where that is more than
/// 10 mm away; `name` is what the message calls the point.
Result<std::optional<std::int32_t>> nodeNear(const BlockGraph& graph,
                                             const std::optional<glm::dvec3>& pointMm,
                                             const char* name);

/// The segments to visit, in order; what is left out goes to `notes`. The graph has at least one
/// node. Empty where the given ends contradict each other. O(n log n).
std::vector<Segment> segmentsToVisit(const BlockGraph& graph, const GivenEnds& given, EndRule rule,
                                     std::vector<std::string>& notes);

}  // namespace haustra::centerline
