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
#include <tuple>
#include <utility>

namespace haustra::topology {
namespace {

constexpr double smallestSegmentMl = 2.0;
constexpr double shortestSegmentMm = 25.0;
constexpr std::size_t mostSegments = 12;
// A path ends where this ball still fits; beyond lie a catheter, a tip between folds, the wall.
constexpr double endRadiusMm = 3.0;
// A point given by a person may be this far from the lumen.
constexpr double farthestPointMm = 10.0;

/// One segment of the lumen, by the nodes at its ends; a given end is a person's choice.
struct Segment {
    std::int32_t first = 0, last = 0;
    bool firstGiven = false, lastGiven = false;
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

/// The ends of the path along one component: `first` and `last` where given; one that is not is
/// the tip farthest from the other, sought from the deepest place where neither is.
std::pair<std::int32_t, std::int32_t> endsOf(const BlockGraph& graph, std::int32_t component,
                                             std::optional<std::int32_t> first,
                                             std::optional<std::int32_t> last) {
    const auto tipFrom = [&](std::int32_t node) {
        return farthestTip(graph, growWidestTree(graph, node), EndShape::any);
    };
    if (!first)
        first = tipFrom(last ? *last : tipFrom(graph.components[std::size_t(component)].deepest));
    if (!last) last = tipFrom(*first);
    return {*first, *last};
}

glm::dvec3 middleOf(const BlockGraph& graph) {
    glm::dvec3 lo(1e30), hi(-1e30);
    for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
        lo = glm::min(lo, graph.positionMm(std::int32_t(n)));
        hi = glm::max(hi, graph.positionMm(std::int32_t(n)));
    }
    return 0.5 * (lo + hi);
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
    const auto componentOf = [&](const std::optional<std::int32_t>& node) {
        return node ? graph.nodes[std::size_t(*node)].component : -1;
    };
    const std::int32_t rectumComponent = componentOf(*rectum), cecumComponent = componentOf(*cecum);

    // The components worth visiting, largest first.
    TracedCenterline traced;
    std::vector<std::int32_t> candidates;
    for (std::size_t c = 0; c < graph.components.size(); ++c)
        candidates.push_back(std::int32_t(c));
    std::stable_sort(candidates.begin(), candidates.end(), [&](std::int32_t a, std::int32_t b) {
        return graph.components[std::size_t(a)].voxels > graph.components[std::size_t(b)].voxels;
    });
    std::vector<Segment> segments;
    std::vector<SegmentEnds> ends;
    std::optional<SegmentVisit> rectumVisit, cecumVisit;
    double leftOutMl = 0.0;
    std::size_t leftOut = 0;
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        const std::int32_t c = candidates[n];
        const double volumeMl = double(graph.components[std::size_t(c)].voxels) *
                                labels.grid().voxelVolumeMm3() / 1000.0;
        const bool asked = c == rectumComponent || c == cecumComponent;
        const bool onlyAsked = rectumComponent >= 0 && rectumComponent == cecumComponent;
        bool visit = asked || (!onlyAsked && segments.size() < mostSegments &&
                               (n == 0 || volumeMl >= smallestSegmentMl));
        if (visit) {
            Segment segment{0, 0, c == rectumComponent, c == cecumComponent};
            std::tie(segment.first, segment.last) =
                endsOf(graph, c, segment.firstGiven ? *rectum : std::nullopt,
                       segment.lastGiven ? *cecum : std::nullopt);
            const SegmentEnds end{graph.positionMm(segment.first), graph.positionMm(segment.last)};
            visit = asked || n == 0 || glm::distance(end.firstMm, end.lastMm) >= shortestSegmentMm;
            if (visit) {
                if (segment.firstGiven) rectumVisit = {segments.size(), false};
                if (segment.lastGiven) cecumVisit = {segments.size(), false};
                segments.push_back(segment);
                ends.push_back(end);
            }
        }
        if (!visit) ++leftOut, leftOutMl += volumeMl;
        progress(0.1 + 0.5 * double(n + 1) / double(candidates.size()));
    }
    if (leftOut > 0) {
        traced.notes.push_back(format("%.0f small pieces of the lumen left out, %.1f ml in all",
                                      double(leftOut), leftOutMl));
    }

    std::vector<CurvePoint> curve;
    const std::vector<SegmentVisit> order =
        orderSegments(ends, middleOf(graph), rectumVisit, cecumVisit);
    for (std::size_t n = 0; n < order.size(); ++n) {
        Segment segment = segments[order[n].segment];
        if (order[n].reversed) {
            std::swap(segment.first, segment.last);
            std::swap(segment.firstGiven, segment.lastGiven);
        }
        const PathTree tree = growWidestTree(graph, segment.first);
        if (n + 1 == order.size() && !segment.lastGiven)
            segment.last = farthestTip(graph, tree, EndShape::pouch);
        std::vector<glm::ivec3> path =
            refineToVoxels(graph, distanceMm, centreRoute(graph, pathTo(tree, segment.last)));
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
