// Streaks: what a scanner reconstructs from rays that too few photons pass, or that metal hardens.
#pragma once

#include "core/volume.h"

#include <cstdint>

namespace haustra::phantom {

/// A ray that a share e^−p of its photons passes has a logarithm of variance in proportion to e^p
/// (Hsieh, Med. Phys. 1998; 25: 2139), which filtered backprojection spreads along the ray: from
/// side to side of the pelvis, where both hips lie in the way. Metal also hardens the beam: with
/// photons of two energies whose attenuation is 1 ∓ 0.4 of the mean, m of metal reads as
/// m − ln cosh 0.4 m, which gives dark bands between dense parts and bright ones beside them
/// (De Man et al., IEEE Trans. Nucl. Sci. 1999; 46: 691; Barrett & Keat, RadioGraphics 2004; 24:
/// 1679).
struct Streaks {
    std::uint64_t seed = 1;
    /// Standard deviation of the streak noise in HU at a place where every ray crosses
    /// streakWaterMm of water; 0: none. Where rays cross a more (mm of water) its square grows by
    /// e^(0.0193 a), for each ray apart, up to e^3.
    double noiseHu = 0.0;
    bool hardening = false;  ///< of what is over metalHu
};

inline constexpr double streakWaterMm = 400.0, waterPerMm = 0.0193;  ///< at 70 keV
inline constexpr double metalHu = 3500.0;

/// HU to add to `count` slices of a noise-free slab, from its slice `first` on, which is slice
/// `firstOfAll` of the whole; on these slices' grid. Parallel rays at 240 angles in each slice
/// through `slab` on pixels of 1.5 mm or more, noise that depends on seed, slice, angle and bin
/// alone, Ram-Lak filter, backprojection (Kak & Slaney, Principles of Computerized Tomographic
/// Imaging, ch. 3). Rays see no more of the body than the field of view has. The same for any
/// number of threads. O(slices · 240 · pixels).
Volume<float> streaksOf(const Volume<float>& slab, int first, int count, int firstOfAll,
                        const Streaks& streaks, int threads);

}  // namespace haustra::phantom
