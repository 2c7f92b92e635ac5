// The path in the middle of the lumen's cross-sections.
#pragma once

#include "core/volume.h"

#include <cstdint>
#include <vector>

namespace haustra::centerline {

/// Moves a curve's points (LPS, mm) to the centroids of the lumen's cross-sections, in planes
/// across its own course over about 6 mm, and smooths it over 4 mm; twice. Where a wall bulges or
/// folds stand on one side, the place farthest from the wall swings to and fro and cuts bends
/// short; the middle of what a plane cuts does not. A cross-section is what is connected with the
/// point in the plane within two and a half of its distance from the wall, and 5 mm; 40 mm at most.
/// A point that would come nearer to the wall than half of its former distance, or that a wall
/// parts from its former place, stays between; in
/// bridges, and at both ends, nothing moves. Points 1 mm apart. `distanceMm` is
/// distanceToBoundaryMm(labels). The same for any number of threads.
std::vector<glm::dvec3> atCrossSections(const std::vector<glm::dvec3>& curve,
                                        const Volume<std::uint8_t>& labels,
                                        const Volume<float>& distanceMm, int threads);

}  // namespace haustra::centerline
