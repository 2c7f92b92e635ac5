#include "cad/biopsy.h"

#include "core/ct_scan.h"
#include "core/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::cad {

BiopsyTable::BiopsyTable(const TransferFunction& transferFunction) : entries_(4096) {
    for (std::size_t n = 0; n < entries_.size(); ++n) {
        const TransferFunctionPoint point =
            pointAt(transferFunction.points, double(lowestHu) + double(n));
        const double opacity = 1.0 - std::pow(1.0 - point.opacity, biopsyStepMm);
        for (int c = 0; c < 3; ++c)
            entries_[n][c] = float(opacity * linearLight(point.color[c]));
        entries_[n][3] = float(opacity);
    }
}

namespace {

// `inside`: every step lies within the smoothed scan, so that nothing is to be clamped.
template <bool inside>
BiopsyRay march(const BiopsyScan& scan, const BiopsyTable& table, glm::vec3 startVoxel,
                glm::vec3 stepVoxels, RayEnd end) {
    // Within a step of the wall the scan is still half gas.
    constexpr int wallSteps = 3, peakSteps = int(peakMm / biopsyStepMm);
    const glm::ivec3 size = scan.lumen.grid().size;
    const auto row = std::size_t(size.x), slice = row * std::size_t(size.y);
    const std::uint8_t* const labels = scan.lumen.voxels().data();
    const auto airBelow = float(scan.airBelowHu);
    // To the scan's voxels, rounded to the nearest.
    const glm::vec3 first = glm::vec3(scan.scan.origin()) + 0.5f;
    const FourFloats toNearest{first.x, first.y, first.z, 0.0f};
    const auto isLumen = [&](const FourFloats& voxel) {
        const FourInts nearest = __builtin_convertvector(voxel + toNearest, FourInts);
        glm::ivec3 at(nearest[0], nearest[1], nearest[2]);
        if constexpr (!inside) at = glm::clamp(at, glm::ivec3(0), size - 1);
        return labels[std::size_t(at.z) * slice + std::size_t(at.y) * row + std::size_t(at.x)] !=
               std::uint8_t(LumenLabel::outside);
    };
    FourFloats voxel{startVoxel.x, startVoxel.y, startVoxel.z, 0.0f};
    const FourFloats step{stepVoxels.x, stepVoxels.y, stepVoxels.z, 0.0f};
    FourFloats seen{};  // colour and opacity
    BiopsyRay ray;
    bool inTissue = false, opaque = false;
    const auto finish = [&] {
        ray.color = {seen[0], seen[1], seen[2]};
        ray.opacity = seen[3];
        return ray;
    };
    // Four steps are looked up at once, also those behind the one where the ray ends.
    static_assert(biopsySteps % 4 == 0);
    for (int begin = 0; begin < biopsySteps; begin += 4) {
        std::array<FourFloats, 4> voxels;
        for (FourFloats& each : voxels)
            each = voxel, voxel += step;
        FourFloats hus;
        if constexpr (inside) {
            hus = scan.scan.linearWithin(voxels);
        } else {
            for (std::size_t n = 0; n < 4; ++n)
                hus[n] = scan.scan.linear({voxels[n][0], voxels[n][1], voxels[n][2]});
        }
        for (int n = 0; n < 4; ++n) {
            const float hu = hus[n];
            const bool empty = hu < airBelow || isLumen(voxels[std::size_t(n)]);
            if ((inTissue || begin + n >= wallSteps) && empty) {
                ray.reenters = inTissue;
                return finish();
            }
            inTissue |= !empty;
            if (begin + n <= peakSteps) ray.peakHu = std::max(ray.peakHu, hu);
            ray.tissueMm += float(biopsyStepMm);
            if (opaque) continue;
            seen += (1.0f - seen[3]) * table.at(hu);
            if (seen[3] >= float(terminationOpacity)) {
                seen /= seen[3];
                opaque = true;
                if (end == RayEnd::opaque) return finish();
            }
        }
    }
    return finish();
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
