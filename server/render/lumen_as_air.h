// The scan with its tagged residue taken for air, for the endoscopic view.
#pragma once

#include "core/ct_scan.h"

#include <cstdint>

namespace haustra::render {

/// A copy of `ct` in which voxels that `lumen` (same grid) labels as tagged become air, so that the
/// wall beneath shows. Around them, the blurred border between residue and wall becomes the border
/// that air would have there: a voxel's share of residue, judged from its HU between soft tissue
/// and the residue nearby, is replaced by air. Where residue meets air in the lumen nothing is
/// left. A first form, for looking: it mends what is within two voxels of a label and no further,
/// and stands until digital cleansing unmixes the scan's tissues themselves. Deterministic;
/// O(voxels), and some hundred operations for each voxel near a tagged one.
Volume<std::int16_t> lumenAsAir(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& lumen,
                                int threads);

}  // namespace haustra::render
