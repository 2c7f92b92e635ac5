// A volume in a sparse file, for what does not fit into main memory.
#pragma once

#include "core/volume.h"

#include <string>

namespace haustra::bench {

/// Writes `part` into a file of `size` voxels at `corner`; the rest is a hole that reads as zero.
/// Maps the file, which vanishes when the volume does. Same spacing and directions as `part`.
Result<Volume<std::int16_t>> sparseVolume(const std::string& file, const Volume<std::int16_t>& part,
                                          glm::ivec3 size, glm::ivec3 corner);

}  // namespace haustra::bench
