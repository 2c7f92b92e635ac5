// How a phantom is scanned.
#pragma once

#include <glm/glm.hpp>

namespace haustra::phantom {

/// Zero, or what is given here, leaves what the preset draws.
struct ScanOptions {
    /// Width of the reconstructed field, mm, 250…500, in place of the size's 384: small fields cut
    /// the arms and sides off, large ones have large pixels.
    double fieldOfViewMm = 0.0;
    /// Full widths at half maximum of the point spread along x, y and z, mm; z is the slice's
    /// thickness. In place of 0.85…1.15 mm in the plane and 1.2 mm across it.
    glm::dvec3 blurMm{0.0};
    /// Edge enhancement of a sharp kernel, 0…0.6: the spread is (1 + o) G(w) − o G(2.2 w) in the
    /// plane, which at an edge overshoots by about a tenth of the step for o = 0.5.
    double overshoot = 0.0;
    double noiseSdHu = 0.0;  ///< 0…100, in place of the preset's
    double grainMm = 1.1;    ///< full width of the noise's grain in the plane, 0.5…4
    /// Pseudo-enhancement: how much brighter (HU, 0…100) beam hardening and scatter make tissue at
    /// the flat edge of a large pool 1500 HU above gas. It falls off over about a centimetre within
    /// the slice, in which the rays lie (Näppi & Yoshida, Med. Image Anal. 2008; 12: 413).
    double pseudoEnhancementHu = 0.0;
    /// Streak noise where few photons pass, as between the hips, HU, 0…100: Streaks::noiseHu. In a
    /// pelvis as wide as 400 mm of water it comes in addition to noiseSdHu.
    double streakHu = 0.0;
    /// A total hip prosthesis, on a side and with a head (28, 32 or 36 mm, the usual ones of hip
    /// registries) that the seed draws: titanium cup and stem, head of cobalt-chrome, with the
    /// streaks of hardened beams.
    bool metalHip = false;
    /// The patient enters the scanner with the feet first: rows of the series run from left to
    /// right and its slices from head to feet (DICOM PS3.3 C.7.3.1.1.2). Of the series that is
    /// written alone: the phantom's volumes are the same.
    bool feetFirst = false;
};

}  // namespace haustra::phantom
