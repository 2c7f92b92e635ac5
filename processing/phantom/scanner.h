// What the CT scanner does to a noise-free body: it blurs, and it adds noise.
#pragma once

#include "core/volume.h"

#include <cstdint>

namespace haustra::phantom {

/// Convolves in place with a Gaussian of the given full widths at half maximum (mm, along i, j, k).
/// The same for any number of threads.
void blur(Volume<float>& volume, glm::dvec3 fwhmMm, int threads);

struct Noise {
    std::uint64_t seed = 1;
    double sdHu = 15.0;
    double correlationMm = 1.1;  ///< full width at half maximum of the grain in the plane
};

/// `clean` plus noise, rounded and clamped to [−1024, 3071]. The noise of a voxel depends on the
/// seed and the place alone: two volumes on one grid with one seed get the same noise.
Volume<std::int16_t> addNoise(const Volume<float>& clean, const Noise& noise, int threads);

}  // namespace haustra::phantom
