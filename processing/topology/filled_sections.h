// Sections of the colon that tagged fluid fills to the roof, with no air of their own.
#pragma once

#include "core/ct_scan.h"
#include "core/tissue.h"

#include <cstdint>
#include <span>

namespace haustra::topology {

/// Labels as tagged the bodies of tagged fluid that open into labelled lumen: with no wall between,
/// only partial volume, over at least what a bowel's cross-section measures. Opacified small bowel
/// and bone lie behind two walls, the ileum behind the narrow ileocecal valve; bone is also less
/// even than fluid. A section that opens into one found so is found too. The voxels `excluded` stay
/// as they are; nothing happens where no label is tagged. `labels` must own its memory. Returns the
/// volume added, ml. O(voxels); a byte a voxel and 4 bytes for each voxel of tagged material and
/// bone.
double addFilledSections(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu,
                         const TissueModel& tissue, std::span<const std::uint32_t> excluded = {});

}  // namespace haustra::topology
