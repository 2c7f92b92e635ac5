// Scans of noise, for laws that hold of any scan.
#pragma once

#include "core/volume.h"

#include <random>

namespace haustra::tests {

/// Voxels of 1 mm: a share `dense` of them 0…100 HU, the others −1000…−950 HU.
inline Volume<std::int16_t> randomVolume(glm::ivec3 size, unsigned seed, double dense) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    Volume<std::int16_t> volume(axisAlignedGrid(size, glm::dvec3(1.0)));
    for (auto& hu : volume.writable())
        hu = std::int16_t(chance(random) < dense ? 100.0 * chance(random)
                                                 : -1000.0 + 50.0 * chance(random));
    return volume;
}

}  // namespace haustra::tests
