// How often each HU occurs in a scan.
#pragma once

#include "core/ct_scan.h"

#include <vector>

namespace haustra::cleansing {

inline constexpr int lowestHu = -1024, highestHu = 3071;

/// Voxels by HU, from lowestHu to highestHu; what is brighter counts as highestHu, and lowestHu and
/// less, the padding outside the scanner's field of view, not at all. The same for any number of
/// threads.
std::vector<double> huHistogram(const CtScan& scan, int threads);

}  // namespace haustra::cleansing
