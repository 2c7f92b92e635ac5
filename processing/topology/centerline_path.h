// The centerline through the lumen.
#pragma once

#include "core/centerline.h"
#include "core/parallel.h"
#include "core/result.h"
#include "core/volume.h"

#include <optional>
#include <string>
#include <vector>

namespace haustra::topology {

struct CenterlineOptions {
    double stepMm = 1.0;
    int threads = 0;
    std::optional<glm::dvec3> rectumMm;  ///< overrules the automatic end point
    std::optional<glm::dvec3> cecumMm;
    Progress progress;
};

struct TracedCenterline {
    Centerline centerline;
    std::vector<std::string> notes;  ///< gaps, components left out …
};

/// The minimum-cost path of Wan et al. (dissertation §1.2.1, [126]) on the exact distance from
/// the boundary, from the rectum to the cecum, through all segments of the lumen worth visiting,
/// smoothed by a B-spline and resampled at `stepMm`. `labels` is 0 outside the lumen; `distanceMm`
/// is distanceToBoundaryMm(labels).
Result<TracedCenterline> traceCenterline(const Volume<std::uint8_t>& labels,
                                         const Volume<float>& distanceMm,
                                         const CenterlineOptions& options = {});

}  // namespace haustra::topology
