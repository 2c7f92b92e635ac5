#include "cad/biopsy.h"

#include "core/ct_scan.h"
#include "core/srgb.h"

#include <algorithm>
#include <cmath>

namespace haustra::cad {

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

namespace {

// `inside`: every step lies within the smoothed scan, so that nothing is to be clamped.
template <bool inside>
BiopsyRay march(const BiopsyScan& scan, const BiopsyTable& table, glm::vec3 voxel, glm::vec3 step,
                RayEnd end) {
    // Within a step of the wall the scan is still half gas.
    constexpr int wallSteps = 3;
    const glm::ivec3 size = scan.lumen.grid().size;
    const auto row = std::size_t(size.x), slice = row * std::size_t(size.y);
    const std::uint8_t* labels = scan.lumen.voxels().data();
    const glm::vec3 origin(scan.scan.origin()), most(size - 1);
    const auto airBelow = float(scan.airBelowHu);
    const auto isLumen = [&] {
        glm::vec3 at = voxel + origin;
        if constexpr (!inside) at = glm::clamp(at, glm::vec3(0.0f), most);
        const glm::ivec3 nearest(at + 0.5f);
        return labels[std::size_t(nearest.z) * slice + std::size_t(nearest.y) * row +
                      std::size_t(nearest.x)] != std::uint8_t(LumenLabel::outside);
    };
    BiopsyRay ray;
    bool inTissue = false, opaque = false;
    for (int n = 0; n < biopsySteps; ++n, voxel += step) {
        const float hu = inside ? scan.scan.linearWithin(voxel) : scan.scan.linear(voxel);
        const bool empty = hu < airBelow || isLumen();
        if ((inTissue || n >= wallSteps) && empty) {
            ray.reenters = inTissue;
            break;
        }
        inTissue |= !empty;
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
            if (end == RayEnd::opaque) break;
        }
    }
    return ray;
}

}  // namespace

BiopsyRay castBiopsyRay(const BiopsyScan& scan, const BiopsyTable& table, glm::dvec3 startMm,
                        glm::dvec3 intoWall, RayEnd end) {
    const glm::dmat4& voxelFromPatient = scan.scan.voxelFromPatient();
    const glm::vec3 voxel(voxelFromPatient * glm::dvec4(startMm, 1.0));
    const glm::vec3 step(biopsyStepMm * (glm::dmat3(voxelFromPatient) * intoWall));
    // Steps add up with rounding, by far less than a hundredth of a voxel.
    constexpr float rounding = 0.01f;
    const glm::vec3 beyond = float(biopsySteps) * step + rounding * glm::sign(step);
    const bool inside = scan.scan.within(voxel) && scan.scan.within(voxel + beyond);
    return inside ? march<true>(scan, table, voxel, step, end)
                  : march<false>(scan, table, voxel, step, end);
}

}  // namespace haustra::cad
