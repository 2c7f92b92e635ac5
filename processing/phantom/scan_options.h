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
};

}  // namespace haustra::phantom
