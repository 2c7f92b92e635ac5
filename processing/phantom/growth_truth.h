// What grows on a phantom's wall, as its truth tells it.
#pragma once

#include "phantom/colon_shape.h"
#include "phantom/phantom.h"

#include <vector>

namespace haustra::phantom {

struct FilledColon;

/// All growths of a colon, polyps in the order of polypsOf.
std::vector<GrowthTruth> growthTruths(const FilledColon& colon, const GrowthOptions& options);

/// Whether a polyp is one of those that GrowthOptions::plainCores wants without a dense core.
bool isPlain(const Growth& polyp, const GrowthOptions& options);

/// How much denser than the wall a polyp is throughout, as GrowthOptions::polypHu wants it, HU.
double densityOf(const Growth& polyp, const GrowthOptions& options);

}  // namespace haustra::phantom
