// Tagged stool that lies in the colon's air without a level of its own.
#pragma once

#include "core/ct_scan.h"
#include "core/tissue.h"

#include <cstdint>
#include <span>

namespace haustra::segmentation {

/// Labels as tagged the bodies of tagged material that touch labelled lumen over a good part of
/// their surface, and the partial volume between them and it. Bone or opacified bowel behind the
/// wall shows the lumen only a small part of its surface through the wall, and is left alone; so is
/// what has more than 30 ml or is little brighter than tagging begins. No body holds voxels that
/// are `excluded`. Those of `bowel`, tagged material as wide as bowel, are of one only where it
/// shows the lumen half of its surface: that is a large ball of stool. `labels` must own its
/// memory. O(voxels); takes two bits a voxel, and 4 bytes for each voxel of the largest tagged body
/// that touches the lumen.
void addTaggedStool(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu,
                    const TissueModel& tissue, std::span<const std::uint32_t> excluded,
                    std::span<const std::uint32_t> bowel);

}  // namespace haustra::segmentation
