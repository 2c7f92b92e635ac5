// How sharply gas turns into wall.
#pragma once

#include "cad/wall_evidence.h"

#include <optional>
#include <string>

namespace haustra::cad {

/// In the median of the dry places of the wall, as shares of the step from gas (0) to the wall's
/// tissue (1), of the cleansed scan as it is.
struct WallEdges {
    double rise = 0.0;  ///< from half a millimetre before the surface to as much behind
    double peak = 0.0;  ///< the greatest within 4 mm behind; over 1 where an edge is enhanced
};
/// None where too little of the wall is dry to tell.
std::optional<WallEdges> wallEdges(const PreparedColon& colon, const WallEvidence& evidence);

/// A warning for readers of a scan whose edges are unlike those that detection has learnt from: a
/// kernel that enhances them makes the wall behind gas brighter than its tissue (polyps are missed
/// by the half), and where they are blurred by a standard deviation over 1.6 mm, small polyps are
/// lost and residue is told as polyps. None of others.
std::optional<std::string> warningOfEdges(const WallEdges& edges);

}  // namespace haustra::cad
