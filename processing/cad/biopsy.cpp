#include "cad/biopsy.h"

#include "core/ct_scan.h"

#include <algorithm>
#include <cmath>

namespace haustra::cad {
namespace {

double linearLight(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

// Between the points around a value; the ends go on.
TransferFunctionPoint pointAt(const std::vector<TransferFunctionPoint>& points, double hu) {
    if (hu <= points.front().hu) return points.front();
    if (hu >= points.back().hu) return points.back();
    const auto above = std::upper_bound(
        points.begin(), points.end(), hu,
        [](double value, const TransferFunctionPoint& point) { return value < point.hu; });
    const TransferFunctionPoint &a = *(above - 1), &b = *above;
    const double share = b.hu > a.hu ? (hu - a.hu) / (b.hu - a.hu) : 0.0;
    return {hu, glm::mix(a.color, b.color, share), glm::mix(a.opacity, b.opacity, share)};
}

}  // namespace

BiopsyTable::BiopsyTable(const TransferFunction& transferFunction) : entries_(4096) {
    for (std::size_t n = 0; n < entries_.size(); ++n) {
        const TransferFunctionPoint point =
            pointAt(transferFunction.points, double(lowestHu) + double(n));
        const double opacity = 1.0 - std::pow(1.0 - point.opacity, biopsyStepMm);
        entries_[n].opacity = float(opacity);
        for (int c = 0; c < 3; ++c)
            entries_[n].color[c] = float(opacity * linearLight(point.color[c]));
    }
}

BiopsyRay castBiopsyRay(const BiopsyScan& scan, const BiopsyTable& table, glm::dvec3 startMm,
                        glm::dvec3 intoWall) {
    // Within a step of the wall the scan is still half gas.
    constexpr int wallSteps = 3;
    const Grid& grid = scan.lumen.grid();
    const glm::dmat4 voxelFromPatient = scan.scan.voxelFromPatient();
    glm::dvec3 voxel(voxelFromPatient * glm::dvec4(startMm, 1.0));
    const glm::dvec3 step = biopsyStepMm * (glm::dmat3(voxelFromPatient) * intoWall);
    const glm::dvec3 most(grid.size - 1);
    BiopsyRay ray;
    bool inTissue = false, opaque = false;
    for (int n = 0; n < biopsySteps; ++n, voxel += step) {
        const float hu = scan.scan.linear(voxel);
        const glm::ivec3 nearest(glm::floor(
            glm::clamp(voxel + 0.5 + glm::dvec3(scan.scan.origin()), glm::dvec3(0.0), most)));
        const bool gas = hu < scan.airBelowHu,
                   lumen = scan.lumen.at(nearest) != std::uint8_t(LumenLabel::outside);
        if ((inTissue || n >= wallSteps) && (gas || lumen)) {
            ray.reenters = inTissue;
            break;
        }
        inTissue |= !gas && !lumen;
        if (n * biopsyStepMm <= peakMm) ray.peakHu = std::max(ray.peakHu, hu);
        ray.tissueMm += float(biopsyStepMm);
        if (opaque) continue;
        const BiopsyTable::Entry& entry = table.at(hu);
        const float through = 1.0f - ray.opacity;
        ray.color += through * entry.color;
        ray.opacity += through * entry.opacity;
        if (ray.opacity >= float(terminationOpacity)) {
            ray.color /= ray.opacity;
            ray.opacity = 1.0f;
            opaque = true;
        }
    }
    return ray;
}

}  // namespace haustra::cad
