// Moving slices by fractions of a pixel and of a slice, linearly interpolated.
#pragma once

#include "core/volume.h"

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::dicom {

/// Places `slice` (matrix.x · matrix.y values) into `result` (size.x · size.y) moved by `shift`
/// pixels (≥ 0). Bilinear; pixels that the slice does not reach, wholly or in part, are padding.
void placeShifted(std::span<const std::int16_t> slice, glm::ivec2 matrix, glm::dvec2 shift,
                  std::span<std::int16_t> result, glm::ivec2 size);

/// The volume on `grid` from slices at the depths `depthSlices` (ascending, in slices of `grid`);
/// beyond the last slice its values go on. Linear between neighbours.
Volume<std::int16_t> resampleDepth(const Volume<std::int16_t>& slices,
                                   const std::vector<double>& depthSlices, const Grid& grid,
                                   int threads);

}  // namespace haustra::dicom
