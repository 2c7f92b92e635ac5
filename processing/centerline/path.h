// The centerline through the lumen.
#pragma once

#include "centerline/segments.h"
#include "core/centerline.h"
#include "core/parallel.h"
#include "core/result.h"
#include "core/volume.h"

#include <optional>
#include <string>
#include <vector>

namespace haustra::centerline {

/// What of the lumen is its middle: where a plane across the path cuts it, the centroid, or what is
/// farthest from the wall.
enum class Middle { crossSections, deepest };

struct CenterlineOptions {
    double stepMm = 1.0;
    Middle middle = Middle::crossSections;
    int threads = 0;
    std::optional<glm::dvec3> rectumMm;  ///< overrules the automatic end point (patient, LPS)
    std::optional<glm::dvec3> cecumMm;
    EndRule ends = EndRule::rectumToCecum;
    bool branches = false;           ///< traces side branches too, as in a tree of vessels
    double shortestBranchMm = 15.0;  ///< outside the balls inscribed along what it leaves
    Progress progress;
};

struct TracedCenterline {
    Centerline centerline;
    /// From a place on the centerline, or on a branch before, to the tip; arcs count from there.
    std::vector<Centerline> branches;
    std::vector<std::string> notes;  ///< gaps, components left out …
};

/// The centerline from the rectum to the cecum through all segments of the lumen worth a visit, or
/// between the ends that another EndRule finds; a given end overrules either (Wan et al., IEEE TMI
/// 21:1450, 2002; dissertation §1.2.1 [126]). `labels` is 0 outside the lumen; `distanceMm` is
/// distanceToBoundaryMm(labels).
///
/// In each 6-connected segment the ends are found automatically, the route between them is the
/// minimum-cost spanning tree's (it passes no leak while the colon is wider), the line within it
/// minimises ∫ ds / distance from the boundary, a B-spline smooths it, and its points move to the
/// middle of the lumen's cross-sections (centerline_cross_sections.h). Every sample outside a
/// gap is inside the lumen; its radius is the distance field there. A straight line of samples
/// marked as a gap joins one segment to the next; samples in voxels labelled LumenLabel::bridge are
/// marked so as well. Samples are `stepMm` apart but for rounding so
/// that both ends are samples. The same for any number of threads.
///
/// Fails where the grids differ, a given end is more than 10 mm outside the lumen (badInput), or
/// the lumen is empty or a speck (noResult). O(n log n) in the lumen's voxels, n an eighth of them;
/// takes some 60 bytes a node and 4 bytes for each eight voxels of the grid, beside the volumes.
Result<TracedCenterline> traceCenterline(const Volume<std::uint8_t>& labels,
                                         const Volume<float>& distanceMm,
                                         const CenterlineOptions& options = {});

}  // namespace haustra::centerline
