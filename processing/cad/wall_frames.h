// Which way the strip runs at each sample of the wall.
#pragma once

#include "cad/wall_samples.h"
#include "core/flat_map.h"

#include <vector>

#include <glm/glm.hpp>

namespace haustra::cad {

/// Unit vectors along the wall at each sample, towards the cecum as the strip has it; where the
/// flat map does not reach (the closed ends), any. A conformal map keeps angles, so that these and
/// what is square to them are the strip's own axes. Of samples that are joined. O(samples).
std::vector<glm::vec3> stripDirections(const WallSamples& samples, const FlatMap& flat,
                                       int threads);

}  // namespace haustra::cad
