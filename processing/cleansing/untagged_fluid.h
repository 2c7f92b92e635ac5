// Fluid without tagging taken out of the lumen.
#pragma once

#include "core/ct_scan.h"
#include "core/volume.h"

namespace haustra::cleansing {

/// Where `labels` (LumenLabel, on the grid of `hu`) says untagged fluid, HU fall by the median of
/// that fluid deep inside less `airHu`. In the voxels beside it they fall by that times the share
/// of lumen among the 27 voxels around (binomial weights), so that the new edge is as blurred as
/// any other. HU never fall below `airHu`. The wall stands where the label ends: a polyp as bright
/// as the fluid cannot be told from it. No wall stands between that fluid and tagged sediment, so
/// what was lumen there in `before`, the segmentation, and is not in `labels`, becomes untagged
/// fluid again. `hu` and `labels` must own their memory. The same for any number of threads.
void takeOutUntagged(Volume<std::int16_t>& hu, Volume<std::uint8_t>& labels,
                     const Volume<std::uint8_t>& before, double airHu, int threads);

bool hasUntagged(const Volume<std::uint8_t>& labels);

}  // namespace haustra::cleansing
