// Walls too thin to rise above the wall's HU: where two loops of bowel touch.
#pragma once

#include "core/ct_scan.h"
#include "segmentation/bowel_contents.h"

namespace haustra::segmentation {

struct ThinWallOptions {
    double reachMm = 3.0;      ///< how far on either side the plain content may begin
    double softHu = 40.0;      ///< what walls are made of
    double leastShare = 0.10;  ///< rise over the gas, as a share of the way to soft tissue
    double leastSds = 4.0;     ///< … and in the noise's standard deviations
    double smoothingMm = 0.8;  ///< standard deviation, against noise
    double speckMm2 = 8.0;     ///< smaller sheets are noise
    int threads = 0;
};

/// One byte a voxel: 1 where a voxel of gas (or tagged material) lies in a sheet of HU nearer to
/// soft tissue's than what lies on both sides of it, along one of 13 directions.
///
/// A wall of thickness t, blurred by a point spread of standard deviation σ, rises over the gas by
/// (μ_soft − μ_gas) t / (σ √(2π)) where t < σ: half a millimetre at σ = 0.8 mm by 260 HU. An
/// opening wider than the point spread has the content's own HU in its middle. So what parts two
/// loops of bowel shows, though no threshold keeps them apart.
Volume<std::uint8_t> findThinWalls(const Volume<std::int16_t>& hu, const BowelContents& contents,
                                   const ThinWallOptions& options);

}  // namespace haustra::segmentation
