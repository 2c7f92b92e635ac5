// How finely a scan was taken, beside what its reading asks for.
#pragma once

#include "core/grid.h"
#include "core/source_series.h"

#include <optional>
#include <string>

namespace haustra {

/// CT colonography is scanned with slices of at most 3 mm, at most 1.5 mm apart (Korean J. Radiol.
/// 2007; 8: 264).
inline constexpr double widestReadableStepMm = 1.5, thickestReadableSliceMm = 3.0;

/// A warning for readers of a colon whose scan is coarser than that, along any axis: by the voxels,
/// and by the series that they came from, where it is known (nullptr: not), whose widest gap counts
/// though it was resampled, and whose slices may overlap. None of a scan that is fine enough. Up to
/// half over the limits it speaks of small and flat polyps (detection was judged on phantoms of 2.1
/// mm), beyond of all: in slices of 5 mm detection misses sessile ones of 14 mm.
std::optional<std::string> coarsenessOf(const Grid& grid, const SourceSeries* series);

}  // namespace haustra
