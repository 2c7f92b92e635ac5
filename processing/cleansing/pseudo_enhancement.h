// How much brighter beam hardening and scatter make what lies beside tagging.
#pragma once

#include "cleansing/smooth_field.h"
#include "core/ct_scan.h"
#include "core/tissue.h"

#include <cstdint>
#include <span>

namespace haustra::cleansing {

/// The HU that dense contents add to what is around them within the slice, in which the rays lie:
/// the tagging's excess over gas, spread by a Gaussian and scaled (adaptive density correction,
/// Näppi and Yoshida, Med. Image Anal. 2008; 12: 413). Spread and scale are the scan's own.
struct PseudoEnhancement {
    double widthMm = 0.0;  ///< of the spread, full at half maximum; 0 where there is none
    double gain = 0.0;     ///< HU for each HU of spread excess
    SmoothField excessHu;  ///< spread, over the whole scan; empty where there is none
    glm::ivec3 begin{0};   ///< the field's voxel that is the scan's first

    explicit operator bool() const { return gain > 0.0; }
    double at(int i, int j, int k) const { return gain * excessHu.at(i + begin.x, j + begin.y, k); }
    /// Takes it off the HU of the scan's voxel `first` and of those after it along i.
    void takeOff(glm::ivec3 first, std::span<std::int16_t> row) const;
    /// What the flat edge of a large pool gains that is 1500 HU denser than gas.
    double edgeHu() const { return 750.0 * gain; }
};

/// Fits the scale and one of five spreads, 8 to 32 mm wide, by least squares to the HU of the
/// colon's gas, deeper inside it than the blur reaches. Gas alone is the same material near tagging
/// and far from it: soft tissue beside a pool is wall, and farther off another tissue. HU end at
/// −1024, which cuts off part of the gas' noise and so lessens what enhancement adds to its mean;
/// the fitted scale is corrected for that. It is at most the wall's own scale, from where the blur
/// ends to 1.5 mm farther, and two standard errors of that (by leaving out one slab of 20 mm after
/// the other): what is taken off the wall too much makes fat of it. Where too little wall is seen,
/// or in one slab alone, the gas' scale stands. Nor do contents gain more than a third of their
/// mean HU over soft tissue: scanners reckon with water, and what is as dense adds nothing. None
/// where the flat edge of a pool would gain less than 4 HU. `scan` and `segmentation` may be the
/// part of a larger scan, on grid `whole`, that begins at its voxel `from` and holds what is within
/// 20 mm of the labels; cells and samples are counted from there. O(voxels); the same for any
/// number of threads.
PseudoEnhancement measurePseudoEnhancement(const CtScan& scan, const TissueModel& tissue,
                                           const Volume<std::uint8_t>& segmentation,
                                           const Grid& whole, glm::ivec3 from, int threads);
inline PseudoEnhancement measurePseudoEnhancement(const CtScan& scan, const TissueModel& tissue,
                                                  const Volume<std::uint8_t>& segmentation,
                                                  int threads) {
    return measurePseudoEnhancement(scan, tissue, segmentation, scan.hu.grid(), glm::ivec3(0),
                                    threads);
}

}  // namespace haustra::cleansing
