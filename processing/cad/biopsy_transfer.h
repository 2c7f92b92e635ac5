// The electronic biopsy's transfer function.
#pragma once

#include "core/optics.h"

namespace haustra::cad {

struct WallStatistics;

/// The one for a scan whose soft tissue and fat have the usual HU: that of the preset "biopsy".
/// Blue are the lowest densities, green the middle ones, red the highest (fig. 6.1).
TransferFunction fixedBiopsyTransfer();

/// Derived from what this scan's wall and fat are (§7.2.5): the fixed one with its HU scale moved
/// and stretched so that fat and wall have the colours that they have in a usual scan. Where the
/// smoothed scan is still noisy, red begins only where noise alone leads one place of the wall in
/// forty.
TransferFunction automaticBiopsyTransfer(const WallStatistics& statistics);

}  // namespace haustra::cad
