#include "centerline/segments.h"

#include "centerline/order.h"
#include "centerline/tip.h"
#include "core/printed_text.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

namespace haustra::centerline {
namespace {

constexpr double smallestSegmentMl = 2.0;
constexpr std::size_t mostSegments = 12;
// A point given by a person may be this far from the lumen.
constexpr double farthestPointMm = 10.0;

/// The segment of one component. An end that is not given is the tip farthest from the other one,
/// which is sought from the deepest place where neither is given.
Segment segmentOf(const BlockGraph& graph, std::int32_t component,
                  std::optional<std::int32_t> first, std::optional<std::int32_t> last) {
    Segment segment{{}, {}, first.has_value(), last.has_value()};
    const std::int32_t deepest = graph.components[std::size_t(component)].deepest;
    PathTree tree = growWidestTree(graph, first.value_or(last.value_or(deepest)));
    if (!first) {
        if (!last) {
            const std::int32_t oneEnd = longestPathEnd(tree);
            tree = rerooted(std::move(tree), oneEnd);
            last = farthestTip(graph, tree, EndShape::any);
            tree = rerooted(std::move(tree), *last);
        }
        first = farthestTip(graph, tree, EndShape::any);
        tree = rerooted(std::move(tree), *first);
    }
    if (!last) last = farthestTip(graph, tree, EndShape::any);
    segment.route = pathTo(tree, *last);
    segment.widest = std::move(tree);
    return segment;
}

/// The segment of one component between the ends of its longest path, the lower one first.
Segment longestSegmentOf(const BlockGraph& graph, std::int32_t component) {
    const auto shortestFrom = [&](std::int32_t source) {
        return growCheapestTree(graph, std::span(&source, 1), StepCost::length);
    };
    const std::int32_t deepest = graph.components[std::size_t(component)].deepest;
    const std::int32_t oneEnd = longestPathEnd(shortestFrom(deepest));
    std::int32_t last = farthestTip(graph, shortestFrom(oneEnd), EndShape::any);
    std::int32_t first = farthestTip(graph, shortestFrom(last), EndShape::any);
    if (graph.positionMm(last).z < graph.positionMm(first).z) std::swap(first, last);
    Segment segment;
    segment.widest = growWidestTree(graph, first);
    segment.route = pathTo(segment.widest, last);
    return segment;
}

void reverse(Segment& segment) {
    std::reverse(segment.route.begin(), segment.route.end());
    std::swap(segment.firstGiven, segment.lastGiven);
    segment.widest = rerooted(std::move(segment.widest), segment.route.front());
}

glm::dvec3 middleOf(const BlockGraph& graph) {
    glm::dvec3 lo(1e30), hi(-1e30);
    for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
        lo = glm::min(lo, graph.positionMm(std::int32_t(n)));
        hi = glm::max(hi, graph.positionMm(std::int32_t(n)));
    }
    return 0.5 * (lo + hi);
}

/// The segments worth a visit, largest first; what is left out goes to `notes`.
std::vector<Segment> findSegments(const BlockGraph& graph, const GivenEnds& given, EndRule rule,
                                  std::vector<std::string>& notes) {
    const auto componentOf = [&](const std::optional<std::int32_t>& node) {
        return node ? graph.nodes[std::size_t(*node)].component : -1;
    };
    const std::int32_t first = componentOf(given.first), last = componentOf(given.last);
    const bool onlyGiven = given.first && first == last;
    const std::size_t most = rule == EndRule::farthest ? 1 : mostSegments;
    std::vector<std::int32_t> bySize(graph.components.size());
    std::iota(bySize.begin(), bySize.end(), 0);
    std::stable_sort(bySize.begin(), bySize.end(), [&](std::int32_t a, std::int32_t b) {
        return graph.components[std::size_t(a)].voxels > graph.components[std::size_t(b)].voxels;
    });
    std::vector<Segment> segments;
    double leftOutMl = 0.0;
    int leftOut = 0;
    for (const std::int32_t c : bySize) {
        const BlockGraph::Component& component = graph.components[std::size_t(c)];
        const double volumeMl = double(component.voxels) * graph.grid.voxelVolumeMm3() / 1000.0;
        const bool isGiven = c == first || c == last;
        const bool large = volumeMl >= smallestSegmentMl || c == bySize.front();
        if (isGiven || (large && !onlyGiven && segments.size() < most)) {
            segments.push_back(!isGiven && rule == EndRule::farthest
                                   ? longestSegmentOf(graph, c)
                                   : segmentOf(graph, c, c == first ? given.first : std::nullopt,
                                               c == last ? given.last : std::nullopt));
        } else {
            leftOutMl += volumeMl;
            ++leftOut;
        }
    }
    if (leftOut > 0) {
        notes.push_back(printed("%.0f small pieces of the lumen left out, %.1f ml in all",
                                double(leftOut), leftOutMl));
    }
    return segments;
}

/// orderSegments for these; the segments that it leaves out go to `notes`.
std::vector<SegmentVisit> orderOf(const std::vector<Segment>& segments, const BlockGraph& graph,
                                  std::vector<std::string>& notes) {
    std::vector<SegmentEnds> ends;
    std::optional<SegmentVisit> rectum, cecum;
    for (std::size_t n = 0; n < segments.size(); ++n) {
        const std::vector<std::int32_t>& route = segments[n].route;
        ends.push_back({graph.positionMm(route.front()), graph.positionMm(route.back()), 0.0});
        for (std::size_t p = 1; p < route.size(); ++p) {
            ends.back().lengthMm +=
                glm::distance(graph.positionMm(route[p]), graph.positionMm(route[p - 1]));
        }
        if (segments[n].firstGiven) rectum = {n, false};
        if (segments[n].lastGiven) cecum = {n, false};
    }
    const std::vector<SegmentVisit> order = orderSegments(ends, middleOf(graph), rectum, cecum);
    for (std::size_t n = 0; n < segments.size(); ++n) {
        if (std::any_of(order.begin(), order.end(),
                        [&](const SegmentVisit& v) { return v.segment == n; }))
            continue;
        const glm::dvec3 at = 0.5 * (ends[n].firstMm + ends[n].lastMm);
        notes.push_back(printed(
            "a segment of %.0f mm at (%.0f, %.0f, %.0f) mm lies too far off the way to be visited",
            ends[n].lengthMm, at.x, at.y, at.z));
    }
    return order;
}

}  // namespace

Result<std::optional<std::int32_t>> nodeNear(const BlockGraph& graph,
                                             const std::optional<glm::dvec3>& pointMm,
                                             const char* name) {
    if (!pointMm) return std::optional<std::int32_t>();
    const std::int32_t node = graph.nearest(*pointMm);
    const double away = glm::distance(graph.positionMm(node), *pointMm);
    if (!(away <= farthestPointMm)) {
        return fail(ErrorKind::badInput,
                    std::string("the point given as the ") + name + " lies " +
                        printed("%.0f mm outside the lumen", away),
                    "centerline");
    }
    return std::optional<std::int32_t>(node);
}

std::vector<Segment> segmentsToVisit(const BlockGraph& graph, const GivenEnds& given, EndRule rule,
                                     std::vector<std::string>& notes) {
    std::vector<Segment> segments = findSegments(graph, given, rule, notes);
    if (rule == EndRule::farthest && segments.size() == 1) return segments;
    std::vector<Segment> visits;
    for (const SegmentVisit visit : orderOf(segments, graph, notes)) {
        visits.push_back(std::move(segments[visit.segment]));
        if (visit.reversed) reverse(visits.back());
    }
    if (rule == EndRule::rectumToCecum && !visits.empty() && !visits.back().lastGiven) {
        Segment& last = visits.back();
        last.route = pathTo(last.widest, farthestTip(graph, last.widest, EndShape::pouch));
    }
    return visits;
}

}  // namespace haustra::centerline
