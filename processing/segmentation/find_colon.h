// Finding the colon in a CT scan: its lumen, and how sure that is.
#pragma once

#include "core/colon_edits.h"
#include "core/colon_record.h"
#include "core/ct_scan.h"
#include "core/parallel.h"
#include "core/result.h"
#include "core/tissue.h"

#include <string>
#include <vector>

namespace haustra::segmentation {

struct ColonOptions {
    ColonEdits edits;
    int threads = 0;
    Progress progress;
};

struct FoundColon {
    Volume<std::uint8_t> labels;  ///< LumenLabel: one 6-connected piece
    glm::dvec3 gravity{0.0};      ///< unit, LPS: as the air–fluid levels show it
    ColonRecord record;
    std::vector<std::string> notes;  ///< for the log: how the patient lay …
};

/// The colon's gas and tagged material as one lumen from the rectum to the cecum.
///
/// Gas and tagged material are cut into tube pieces at their necks (cutIntoPieces); each orifice,
/// thin wall and way through soft tissue between two of them is a junction with odds
/// (makePieceGraph); the colon is the most likely chain of pieces by place in the body, calibre and
/// junctions (findChains); what is on it, or is a sac of it, is lumen, and no other bowel is
/// (layLabels). What a person cuts is a wall from the first on: gas that it parts from the room's
/// air, as at a stoma, is bowel's. Walls that touching loops share are rebuilt; a collapse is
/// crossed by a bridge through soft tissue.
///
/// Fails where the scan has no bowel gas, or too little of a distended colon for a virtual
/// colonoscopy, unless a seed says otherwise (noResult); where a point of the edits has neither gas
/// nor fluid within 3 mm (badInput). The same for any number of threads. O(voxels).
Result<FoundColon> findColon(const CtScan& scan, const TissueModel& tissue,
                             const ColonOptions& options = {});

/// The same for a mask (0 is outside, LumenLabel::tagged and untagged are fluid, all else gas) that
/// another program made of `scan`, or of a scan that is not known (null; `tissue` then says how
/// gas, tagged material and soft tissue are drawn). What of the mask is tagged, and where down is,
/// is the scan's to say. The mask ends where it ends: nothing but bridges is added to it; what is
/// not on the chain is left out, and a note says how much. A mask that lies in the scan's soft
/// tissue for more than a tenth is doubted, as another scan's. Fails as findColon does, and where
/// the mask is not on the scan's grid (badInput).
Result<FoundColon> findColonInMask(const Volume<std::uint8_t>& mask, const CtScan* scan,
                                   const TissueModel& tissue, const ColonOptions& options = {});

}  // namespace haustra::segmentation
