#include "topology/centerline_path.h"

#include "topology/centerline_graph.h"
#include "topology/centerline_order.h"
#include "topology/centerline_search.h"
#include "topology/centerline_spline.h"
#include "topology/centerline_tip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

namespace haustra::topology {
namespace {

constexpr double smallestSegmentMl = 2.0;
constexpr std::size_t mostSegments = 12;
// A path ends where this ball still fits; beyond lie a catheter, a tip between folds, the wall.
constexpr double endRadiusMm = 3.0;
// A point given by a person may be this far from the lumen.
constexpr double farthestPointMm = 10.0;

using Route = std::vector<std::int32_t>;  // nodes of the block graph

/// One segment of the lumen with the route along it; a given end is a person's choice.
struct Segment {
    Route route;
    bool firstGiven = false, lastGiven = false;
};

/// The ends that a person chose, as nodes.
struct GivenEnds {
    std::optional<std::int32_t> rectum, cecum;
};

/// A point of the whole curve before resampling.
struct CurvePoint {
    glm::dvec3 positionMm{0.0};
    bool gapBefore = false;  ///< nothing but a guess joins it to the point before
};

std::string format(const char* pattern, double a, double b = 0.0, double c = 0.0, double d = 0.0) {
    std::array<char, 200> text;
    std::snprintf(text.data(), text.size(), pattern, a, b, c, d);
    return text.data();
}

Result<std::optional<std::int32_t>> nodeNear(const BlockGraph& graph,
                                             const std::optional<glm::dvec3>& pointMm,
                                             const char* name) {
    if (!pointMm) return std::optional<std::int32_t>();
    const std::int32_t node = graph.nearest(*pointMm);
    const double away = glm::distance(graph.positionMm(node), *pointMm);
    if (!(away <= farthestPointMm)) {
        return fail(ErrorKind::badInput,
                    std::string("the point given as the ") + name + " lies " +
                        format("%.0f mm outside the lumen", away),
                    "centerline");
    }
    return std::optional<std::int32_t>(node);
}

/// Cuts what is too narrow off the ends, but never more than leaves the widest place.
void trimEnds(std::vector<glm::ivec3>& path, const Volume<float>& distanceMm, bool front,
              bool back) {
    double widest = 0.0;
    for (const glm::ivec3 v : path)
        widest = std::max(widest, double(distanceMm.at(v)));
    const auto wideEnough = [&, limit = std::min(endRadiusMm, 0.5 * widest)](glm::ivec3 v) {
        return double(distanceMm.at(v)) >= limit;
    };
    if (back) path.erase(std::find_if(path.rbegin(), path.rend(), wideEnough).base(), path.end());
    if (front) path.erase(path.begin(), std::find_if(path.begin(), path.end(), wideEnough));
}

/// The route along one component from `first` to `last`. An end that is not given is the tip
/// farthest from the other one, which is sought from the deepest place where neither is given.
Route routeAlong(const BlockGraph& graph, std::int32_t component, std::optional<std::int32_t> first,
                 std::optional<std::int32_t> last) {
    const auto towards = [&](const PathTree& tree, std::optional<std::int32_t> end) {
        return pathTo(tree, end ? *end : farthestTip(graph, tree, EndShape::any));
    };
    if (first) return towards(growWidestTree(graph, *first), last);
    if (!last) {
        const std::int32_t deepest = graph.components[std::size_t(component)].deepest;
        const std::int32_t oneEnd = longestPathEnd(growWidestTree(graph, deepest));
        last = farthestTip(graph, growWidestTree(graph, oneEnd), EndShape::any);
    }
    Route route = towards(growWidestTree(graph, *last), first);
    std::reverse(route.begin(), route.end());
    return route;
}

glm::dvec3 middleOf(const BlockGraph& graph) {
    glm::dvec3 lo(1e30), hi(-1e30);
    for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
        lo = glm::min(lo, graph.positionMm(std::int32_t(n)));
        hi = glm::max(hi, graph.positionMm(std::int32_t(n)));
    }
    return 0.5 * (lo + hi);
}

/// The segments worth a visit, largest first, with their ends; what is left out goes to `notes`.
std::vector<Segment> findSegments(const BlockGraph& graph, const GivenEnds& given,
                                  std::vector<std::string>& notes) {
    const auto componentOf = [&](const std::optional<std::int32_t>& node) {
        return node ? graph.nodes[std::size_t(*node)].component : -1;
    };
    const std::int32_t rectum = componentOf(given.rectum), cecum = componentOf(given.cecum);
    const bool onlyGiven = given.rectum && rectum == cecum;
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
        const bool isGiven = c == rectum || c == cecum;
        const bool large = volumeMl >= smallestSegmentMl || c == bySize.front();
        if (isGiven || (large && !onlyGiven && segments.size() < mostSegments)) {
            Segment segment{{}, c == rectum, c == cecum};
            segment.route = routeAlong(graph, c, segment.firstGiven ? given.rectum : std::nullopt,
                                       segment.lastGiven ? given.cecum : std::nullopt);
            segments.push_back(std::move(segment));
        } else {
            leftOutMl += volumeMl;
            ++leftOut;
        }
    }
    if (leftOut > 0) {
        notes.push_back(format("%.0f small pieces of the lumen left out, %.1f ml in all",
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
        const Route& route = segments[n].route;
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
        notes.push_back(format(
            "a segment of %.0f mm at (%.0f, %.0f, %.0f) mm lies too far off the way to be visited",
            ends[n].lengthMm, at.x, at.y, at.z));
    }
    return order;
}

/// Samples at equal arcs of about `stepMm`, both ends included.
Centerline resample(const std::vector<CurvePoint>& curve, const Volume<std::uint8_t>& labels,
                    const Volume<float>& distanceMm, double stepMm) {
    const glm::dmat4 voxelFromPatient = labels.grid().voxelFromPatient();
    std::vector<double> arc(curve.size(), 0.0);
    for (std::size_t n = 1; n < curve.size(); ++n) {
        arc[n] = arc[n - 1] + glm::distance(curve[n].positionMm, curve[n - 1].positionMm);
    }
    const auto intervals = std::max<std::size_t>(1, std::size_t(std::lround(arc.back() / stepMm)));
    Centerline line;
    std::size_t n = 0;
    for (std::size_t i = 0; i <= intervals && curve.size() > 1; ++i) {
        CenterlinePoint point;
        point.arcMm = arc.back() * double(i) / double(intervals);
        while (n + 2 < curve.size() && arc[n + 1] < point.arcMm)
            ++n;
        const double between = arc[n + 1] - arc[n];
        const double t =
            between > 0.0 ? std::clamp((point.arcMm - arc[n]) / between, 0.0, 1.0) : 0.0;
        point.positionMm = glm::mix(curve[n].positionMm, curve[n + 1].positionMm, t);
        point.gap = curve[n + 1].gapBefore && t > 0.0 && t < 1.0;
        glm::dvec3 voxel(voxelFromPatient * glm::dvec4(point.positionMm, 1.0));
        if (!point.gap) {
            // The chord between two points inside may pass outside; neither of them does.
            if (!insideLumen(labels, voxel)) {
                point.positionMm = curve[t < 0.5 ? n : n + 1].positionMm;
                voxel = glm::dvec3(voxelFromPatient * glm::dvec4(point.positionMm, 1.0));
            }
            point.radiusMm = trilinear(distanceMm, voxel);
        }
        line.points.push_back(point);
    }
    return line;
}

}  // namespace

Result<TracedCenterline> traceCenterline(const Volume<std::uint8_t>& labels,
                                         const Volume<float>& distanceMm,
                                         const CenterlineOptions& options) {
    const auto progress = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    if (!sameGrid(labels.grid(), distanceMm.grid())) {
        return fail(ErrorKind::badInput, "the lumen and its distance field are on different grids",
                    "centerline");
    }
    if (!(options.stepMm > 0.0))
        return fail(ErrorKind::badInput, "the step must be positive", "centerline");
    const BlockGraph graph = makeBlockGraph(labels, distanceMm, options.threads);
    if (graph.nodes.empty()) return fail(ErrorKind::noResult, "the lumen is empty", "centerline");
    progress(0.1);
    const auto rectum = nodeNear(graph, options.rectumMm, "rectum");
    if (!rectum) return tl::make_unexpected(rectum.error());
    const auto cecum = nodeNear(graph, options.cecumMm, "cecum");
    if (!cecum) return tl::make_unexpected(cecum.error());

    TracedCenterline traced;
    std::vector<Segment> segments = findSegments(graph, {*rectum, *cecum}, traced.notes);
    const std::vector<SegmentVisit> order = orderOf(segments, graph, traced.notes);
    progress(0.6);
    std::vector<CurvePoint> curve;
    for (std::size_t n = 0; n < order.size(); ++n) {
        Segment& segment = segments[order[n].segment];
        if (order[n].reversed) {
            std::reverse(segment.route.begin(), segment.route.end());
            std::swap(segment.firstGiven, segment.lastGiven);
        }
        if (n + 1 == order.size() && !segment.lastGiven) {
            const PathTree tree = growWidestTree(graph, segment.route.front());
            segment.route = pathTo(tree, farthestTip(graph, tree, EndShape::pouch));
        }
        std::vector<glm::ivec3> path =
            refineToVoxels(graph, distanceMm, centreRoute(graph, segment.route));
        trimEnds(path, distanceMm, !segment.firstGiven, !segment.lastGiven);
        if (path.size() < 2) continue;
        const std::vector<glm::dvec3> smooth = smoothInsideLumen(path, labels, distanceMm);
        if (!curve.empty()) {
            const glm::dvec3 from = curve.back().positionMm;
            traced.notes.push_back(
                format("gap of %.0f mm after the segment that ends at (%.0f, %.0f, %.0f) mm",
                       glm::distance(from, smooth.front()), from.x, from.y, from.z));
        }
        for (std::size_t p = 0; p < smooth.size(); ++p)
            curve.push_back({smooth[p], p == 0 && !curve.empty()});
        progress(0.6 + 0.4 * double(n + 1) / double(order.size()));
    }
    if (curve.size() < 2)
        return fail(ErrorKind::noResult, "the lumen is too small to hold a path", "centerline");
    traced.centerline = resample(curve, labels, distanceMm, options.stepMm);
    return traced;
}

}  // namespace haustra::topology
