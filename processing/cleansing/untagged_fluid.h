// Fluid without tagging taken out of the lumen.
#pragma once

#include "core/ct_scan.h"
#include "core/volume.h"

namespace haustra::cleansing {

/// Where `labels` (LumenLabel, on the grid of `hu`) has untagged fluid, HU fall by what that fluid,
/// by its median deep inside, lies above air; beside it by the lumen's share among the 27 voxels
/// around (binomial weights), so that the wall is as blurred as any other. Never below `airHu`. The
/// wall's place is the label's: what a polyp as bright as the fluid adds to it is not known.
/// Between that fluid and tagged sediment stands no wall: what `before`, the segmentation, has
/// there and `labels` has not is fluid, too. `hu` and `labels` must own its memory. The same for
/// any number of threads.
void takeOutUntagged(Volume<std::int16_t>& hu, Volume<std::uint8_t>& labels,
                     const Volume<std::uint8_t>& before, double airHu, int threads);

bool hasUntagged(const Volume<std::uint8_t>& labels);

}  // namespace haustra::cleansing
