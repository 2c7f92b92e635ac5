// Tagged stool that lies in the colon's air without a level of its own.
#pragma once

#include "core/ct_scan.h"
#include "core/tissue.h"
#include "segmentation/bowel_contents.h"

#include <cstdint>
#include <vector>

namespace haustra::segmentation {

/// Of tagged material, voxels that may be of other things than stool, ascending; each in one list.
struct OtherMaterial {
    std::vector<std::uint32_t> surely;  ///< other bowel, or walls that were set up: of no body
    std::vector<std::uint32_t> aside;   ///< crumbs that touch other things more than the lumen
    std::vector<std::uint32_t> bowel;   ///< as wide as bowel
};

/// Labels as tagged, with the partial volume between them and the air, the bodies of tagged
/// material, of eight voxels to 30 ml, that
/// - are well brighter than tagging begins, have an inside, and face labelled lumen by a quarter of
///   their surface: a lump of stool. Bone or opacified bowel behind the wall shows the lumen less,
///   through the wall. Those with voxels of `bowel` face it by half: a loop that is pressed flat
///   against the colon shows a quarter or more. So do lumps of lobes, of which one is of `bowel`;
/// - or face air by three fifths of their surface and are 10 mm wide at most: a crumb, or a film
///   around a head. A coated fold is wider;
/// - or face air by three tenths of it with nothing but blur between and are 4 mm thick at most,
///   volume over facing area: a film on the wall, of 15 mm³ and more, in voxels up to 1.25 mm,
///   which tell blur from a wall. What coats a fold has gas within 6 mm beneath three tenths of it
///   and stays, as it would take the fold along.
///
/// The first holds nothing of `aside` but for such lobes, the latter two nothing of `bowel`. Of
/// these, what is not well tagged as the first is left alone where it may be soft tissue's noise
/// (as measured in gas), and where `contents` have it for tissue: a sharp kernel's overshoot.
/// `labels` must own its memory. O(voxels); takes two bits a voxel, and 4 bytes for each voxel of
/// the largest tagged body that touches the lumen.
void addTaggedStool(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu,
                    const BowelContents& contents, const TissueModel& tissue,
                    const OtherMaterial& other);

}  // namespace haustra::segmentation
