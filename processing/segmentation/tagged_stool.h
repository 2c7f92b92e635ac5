// Tagged stool that lies in the colon's air without a level of its own.
#pragma once

#include "core/ct_scan.h"
#include "core/tissue.h"
#include "segmentation/bowel_contents.h"

#include <cstdint>
#include <vector>

namespace haustra::segmentation {

/// Of tagged material, voxels that may be of other things than stool, ascending.
struct OtherMaterial {
    std::vector<std::uint32_t> surely;  ///< other bowel, or walls that were set up: of no body
    std::vector<std::uint32_t> aside;   ///< crumbs that touch other things more than the lumen
    std::vector<std::uint32_t> bowel;   ///< as wide as bowel
};

/// Labels as tagged, with the partial volume between them and the air, the bodies of tagged
/// material, of 30 ml at most, that
/// - are well brighter than tagging begins, have an inside, and face labelled lumen by a quarter of
///   their surface: a lump of stool. Bone or opacified bowel behind the wall shows the lumen less,
///   through the wall; what is `aside` is of no such body. Those with voxels of `bowel` face it by
///   half: a loop that is pressed flat against the colon shows a quarter or more;
/// - or face air by three fifths of their surface and are 10 mm wide at most: a crumb, or a film
///   around a head. A coated fold is wider;
/// - or face air by three tenths of it with no tissue between, have none within 7 mm on the other
///   side, and are 4 mm thick at most, volume over area: a film on the wall, of 15 mm³ and more, in
///   voxels that are narrow enough to tell. A fold's coat stays, as it would take the fold along.
///
/// Of the latter two, what is not well tagged as the first is left alone where the scan's noise
/// makes soft tissue so bright, and where `contents` have it for tissue: a sharp kernel's
/// overshoot. `labels` must own its memory. O(voxels); takes two bits a voxel, and 4 bytes for each
/// voxel of the largest tagged body that touches the lumen.
void addTaggedStool(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu,
                    const BowelContents& contents, const TissueModel& tissue,
                    const OtherMaterial& other);

}  // namespace haustra::segmentation
