#include "centerline/path.h"

#include "centerline/branches.h"
#include "centerline/cross_sections.h"
#include "centerline/graph.h"
#include "centerline/search.h"
#include "centerline/segments.h"
#include "centerline/spline.h"
#include "core/ct_scan.h"
#include "core/printed_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace haustra::centerline {
namespace {

// A path ends where this ball still fits; beyond lie a catheter, a tip between folds, the wall.
constexpr double endRadiusMm = 3.0;

/// A point of the whole curve before resampling.
struct CurvePoint {
    glm::dvec3 positionMm{0.0};
    bool gapBefore = false;  ///< nothing but a guess joins it to the point before
};

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
        // The chord between two points inside may pass outside; neither of them does.
        if (!point.gap && !insideLumen(labels, voxel)) {
            point.positionMm = curve[t < 0.5 ? n : n + 1].positionMm;
            voxel = glm::dvec3(voxelFromPatient * glm::dvec4(point.positionMm, 1.0));
        }
        point.gap = point.gap || labels.at(glm::ivec3(glm::floor(voxel + 0.5))) ==
                                     std::uint8_t(LumenLabel::bridge);
        if (!point.gap) point.radiusMm = trilinear(distanceMm, voxel);
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
    const auto rectum = TRY(nodeNear(graph, options.rectumMm, "rectum"));
    const auto cecum = TRY(nodeNear(graph, options.cecumMm, "cecum"));

    TracedCenterline traced;
    const std::vector<Segment> segments =
        segmentsToVisit(graph, {rectum, cecum}, options.ends, traced.notes);
    progress(0.6);
    const auto curveAlong = [&](const std::vector<std::int32_t>& route, bool keepFirst,
                                bool keepLast) {
        std::vector<glm::ivec3> path = refineToVoxels(graph, distanceMm, centerRoute(graph, route));
        trimEnds(path, distanceMm, !keepFirst, !keepLast);
        if (path.size() < 2) return std::vector<glm::dvec3>();
        std::vector<glm::dvec3> smooth = smoothInsideLumen(path, labels, distanceMm);
        return options.middle == Middle::deepest
                   ? smooth
                   : atCrossSections(smooth, labels, distanceMm, options.threads);
    };
    std::vector<CurvePoint> curve;
    for (std::size_t n = 0; n < segments.size(); ++n) {
        const Segment& segment = segments[n];
        const std::vector<glm::dvec3> smooth =
            curveAlong(segment.route, segment.firstGiven, segment.lastGiven);
        if (smooth.empty()) continue;
        if (!curve.empty()) {
            const glm::dvec3 from = curve.back().positionMm;
            traced.notes.push_back(
                printed("gap of %.0f mm after the segment that ends at (%.0f, %.0f, %.0f) mm",
                        glm::distance(from, smooth.front()), from.x, from.y, from.z));
        }
        for (std::size_t p = 0; p < smooth.size(); ++p)
            curve.push_back({smooth[p], p == 0 && !curve.empty()});
        progress(0.6 + 0.4 * double(n + 1) / double(segments.size()));
    }
    if (curve.size() < 2)
        return fail(ErrorKind::noResult, "the lumen is too small to hold a path", "centerline");
    traced.centerline = resample(curve, labels, distanceMm, options.stepMm);
    if (!options.branches) return traced;
    for (const Segment& segment : segments) {
        for (const std::vector<std::int32_t>& route :
             sideBranches(graph, segment.widest, segment.route, options.shortestBranchMm)) {
            std::vector<CurvePoint> branch;
            for (const glm::dvec3 point : curveAlong(route, true, false))
                branch.push_back({point, false});
            if (branch.size() < 2) continue;
            traced.branches.push_back(resample(branch, labels, distanceMm, options.stepMm));
        }
    }
    return traced;
}

}  // namespace haustra::centerline
