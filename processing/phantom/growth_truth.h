// What grows on a phantom's wall, as its truth tells it.
#pragma once

#include "phantom/colon_shape.h"
#include "phantom/phantom.h"

#include <string>
#include <vector>

namespace haustra::phantom {

struct FilledColon;

/// All growths of a colon, polyps in the order of polypsOf.
std::vector<GrowthTruth> growthTruths(const FilledColon& colon, const GrowthOptions& options);

/// growths.json of a truth, a line each: {"kind", "neoplastic", "position_mm", "wall_mm",
/// "diameter_mm", "height_mm", "core_hu", "on_fold", "submerged_share"}, "density_hu" where that
/// differs from the wall's, "untagged_share" where it stands in fluid without tagging, and
/// "film_mm" where a film of residue lies over it.
std::string growthsJson(const std::vector<GrowthTruth>& growths);

/// Whether a polyp is one of those that GrowthOptions::plainCores wants without a dense core.
bool isPlain(const Growth& polyp, const GrowthOptions& options);

/// How much denser than the wall a polyp is throughout, as GrowthOptions::polypHu wants it, HU.
double densityOf(const Growth& polyp, const GrowthOptions& options);

}  // namespace haustra::phantom
