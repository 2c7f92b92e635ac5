// What the CT scanner does to a noise-free body: it blurs, and it adds noise.
#pragma once

#include "core/volume.h"

#include <cstdint>
#include <span>

namespace haustra::phantom {

/// Convolves in place with a Gaussian of the given full widths at half maximum (mm, along i, j, k).
/// The same for any number of threads.
void blur(Volume<float>& volume, glm::dvec3 fwhmMm, int threads);

/// Blurs as a reconstruction kernel does: (1 + overshoot) G(fwhm) − overshoot G(2.2 fwhm) in the
/// plane, a Gaussian across it. Keeps the sum.
void reconstruct(Volume<float>& volume, glm::dvec3 fwhmMm, double overshoot, int threads);

/// Adds pseudo-enhancement: what the tagging adds to the untagged body, spread over 16 mm (full
/// width) within each slice and scaled so that a flat edge of 1500 HU gains `edgeHu`.
void enhanceBesideTagging(Volume<float>& tagged, const Volume<float>& untagged, double edgeHu,
                          int threads);

struct Noise {
    std::uint64_t seed = 1;
    double sdHu = 15.0;
    double correlationMm = 1.1;  ///< full width at half maximum of the grain in the plane
};

/// How many slices beyond a slab its blur draws on.
int blurReachSlices(const Grid& grid, glm::dvec3 fwhmMm);

/// `clean` plus noise, rounded and clamped to [−1024, 3071]. The noise of a voxel depends on the
/// seed and the place alone: two volumes on one grid with one seed get the same noise.
Volume<std::int16_t> addNoise(const Volume<float>& clean, const Noise& noise, int threads);

/// The same of `count` slices of a slab, from its slice `first` on, which is slice `firstOfAll` of
/// the whole; into `out`.
void addNoise(const Volume<float>& slab, int first, int count, int firstOfAll, const Noise& noise,
              int threads, std::span<std::int16_t> out);

}  // namespace haustra::phantom
