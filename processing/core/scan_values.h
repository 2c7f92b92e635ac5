// What the scan's values are at a place, or within an ellipse that somebody has drawn on a slice.
#pragma once

#include "core/result.h"
#include "core/view.h"
#include "core/volume.h"

#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>

namespace haustra {

/// The places centerMm + s·halfAMm + t·halfBMm with s² + t² ≤ 1, in patient space; or, where both
/// half axes are zero, the voxel in which the centre lies.
struct ScanRegion {
    glm::dvec3 centerMm{0.0};
    glm::dvec3 halfAMm{0.0}, halfBMm{0.0};  ///< of at most maxHalfAxisMm; need not be orthogonal
    Scan scan = Scan::original;
    Slab slab{};  ///< across the ellipse's plane; a single voxel has none
    bool isPoint() const { return halfAMm == glm::dvec3(0.0) && halfBMm == glm::dvec3(0.0); }
};
inline constexpr double maxHalfAxisMm = 500.0;
/// Of all places where the scan is sampled for one region, those of its slab included.
inline constexpr double maxScanSamples = 4e6;

/// All zero where nothing of the region lies in the scan.
struct ScanStatistics {
    std::size_t samples = 0;
    double meanHu = 0.0, deviationHu = 0.0;  ///< the root of the mean squared distance to the mean
    double leastHu = 0.0, greatestHu = 0.0;
    double areaMm2 = 0.0;  ///< of the ellipse, as far as it lies in the scan; 0 of a voxel
};

/// Fails (badInput) where a number is not finite, the half axes are too long or, without being both
/// zero, span no ellipse, or the slab is out of its bounds.
Result<void> checkScanRegion(const ScanRegion& region);

/// The voxel's own value; of an ellipse, those of equally large cells, in rows along both half
/// axes: at the middle of each the scan is interpolated linearly, and of a slab the mean or
/// maximum is taken as a slice shows it (slabSamples). A cell is no longer than the smallest
/// distance between voxels, and there are at least 16 along each axis. What lies outside the
/// outermost voxels' faces does not count. `scan` is the one that the region names. Fails as
/// checkScanRegion does, and (badInput) past maxScanSamples. Some 20 ns a sample.
Result<ScanStatistics> measureScan(const Volume<std::int16_t>& scan, const ScanRegion& region);

}  // namespace haustra
