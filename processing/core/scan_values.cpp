#include "core/scan_values.h"

#include "core/slice_placement.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace haustra {
namespace {

constexpr double fewestCells = 16.0;  // along an axis

tl::unexpected<Error> refuse(const char* what) {
    return fail(ErrorKind::badInput, what, "scan values");
}

/// Interpolates along a slab.
struct Sampler {
    const Volume<std::int16_t>& scan;
    glm::dmat4 voxelFromPatient;
    Projection projection;
    int aside;
    glm::dvec3 stepVoxels;

    std::optional<double> at(glm::dvec3 positionMm) const {
        const glm::dvec3 middle(voxelFromPatient * glm::dvec4(positionMm, 1.0));
        const glm::dvec3 end = glm::dvec3(scan.grid().size) - 0.5;
        double sum = 0.0, most = -INFINITY;
        int count = 0;
        for (int n = -aside; n <= aside; ++n) {
            const glm::dvec3 voxel = middle + double(n) * stepVoxels;
            if (!glm::all(glm::greaterThanEqual(voxel, glm::dvec3(-0.5))) ||
                !glm::all(glm::lessThanEqual(voxel, end)))
                continue;
            const double hu = trilinear(scan, voxel);
            sum += hu;
            most = std::max(most, hu);
            ++count;
        }
        if (count == 0) return std::nullopt;
        return projection == Projection::maximum ? most : sum / count;
    }
};

ScanStatistics voxelValue(const Volume<std::int16_t>& scan, glm::dvec3 positionMm) {
    const glm::dvec3 voxel = glm::floor(scan.grid().voxelFromPatientPoint(positionMm) + 0.5);
    if (!glm::all(glm::greaterThanEqual(voxel, glm::dvec3(0.0))) ||
        !glm::all(glm::lessThan(voxel, glm::dvec3(scan.grid().size))))
        return {};
    const double hu = scan.at(glm::ivec3(voxel));
    return {1, hu, 0.0, hu, hu, 0.0};
}

}  // namespace

Result<void> checkScanRegion(const ScanRegion& region) {
    if (!isFinite(region.centerMm) || !isFinite(region.halfAMm) || !isFinite(region.halfBMm))
        return refuse("a coordinate is not a finite number");
    TRY(checkSlab(region.slab));
    if (region.isPoint()) return {};
    const double a = glm::length(region.halfAMm), b = glm::length(region.halfBMm);
    if (!(a <= maxHalfAxisMm && b <= maxHalfAxisMm))
        return refuse("a half axis is longer than 500 mm");
    if (!(glm::length(glm::cross(region.halfAMm, region.halfBMm)) > 1e-6 * a * b))
        return refuse("the half axes span no ellipse");
    return {};
}

Result<ScanStatistics> measureScan(const Volume<std::int16_t>& scan, const ScanRegion& region) {
    TRY(checkScanRegion(region));
    if (region.isPoint()) return voxelValue(scan, region.centerMm);

    const glm::dvec3 spacing = scan.grid().spacingMm();
    const double cellMm = std::min(spacing.x, std::min(spacing.y, spacing.z));
    const auto cellsAlong = [&](glm::dvec3 half) {
        return std::max(fewestCells, std::ceil(2.0 * glm::length(half) / cellMm));
    };
    const double along = cellsAlong(region.halfAMm), across = cellsAlong(region.halfBMm);
    const glm::dvec3 normal = glm::cross(region.halfAMm, region.halfBMm);
    const SlabSamples slab = slabSamples(region.slab, normal, scan.grid());
    if (!(along * across * slab.count() <= maxScanSamples))
        return refuse("the region is too large to be measured");

    const glm::dmat4 voxelFromPatient = scan.grid().voxelFromPatient();
    const Sampler sampler{scan, voxelFromPatient, region.slab.projection, slab.aside,
                          glm::dmat3(voxelFromPatient) * slab.stepMm};
    ScanStatistics found;
    found.leastHu = INFINITY, found.greatestHu = -INFINITY;
    std::size_t cells = 0;
    // Welford's recurrence: sums of squares would lose what little values differ.
    double squares = 0.0;
    for (double j = 0.5; j < across; ++j) {
        for (double i = 0.5; i < along; ++i) {
            const double s = 2.0 * i / along - 1.0, t = 2.0 * j / across - 1.0;
            if (s * s + t * t > 1.0) continue;
            ++cells;
            const auto hu = sampler.at(region.centerMm + s * region.halfAMm + t * region.halfBMm);
            if (!hu) continue;
            ++found.samples;
            const double off = *hu - found.meanHu;
            found.meanHu += off / double(found.samples);
            squares += off * (*hu - found.meanHu);
            found.leastHu = std::min(found.leastHu, *hu);
            found.greatestHu = std::max(found.greatestHu, *hu);
        }
    }
    if (found.samples == 0) return ScanStatistics{};
    found.deviationHu = std::sqrt(squares / double(found.samples));
    found.areaMm2 = std::numbers::pi * glm::length(normal) * double(found.samples) / double(cells);
    return found;
}

}  // namespace haustra
