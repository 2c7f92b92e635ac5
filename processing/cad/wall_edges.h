// How sharply gas turns into wall.
#pragma once

#include "cad/wall_evidence.h"

#include <optional>
#include <string>
#include <vector>

namespace haustra::cad {

/// A line from a dry place of the surface into the wall.
struct EdgeLine {
    glm::dvec3 surfaceMm{0.0}, intoWall{0.0};
    glm::dvec3 at(double mm) const { return surfaceMm + mm * intoWall; }
};
/// Of 20,000 to 40,000 places; none where too little of the wall is dry to tell.
std::vector<EdgeLine> edgeLines(const WallEvidence& evidence);

/// Depths behind the surface at which an edge's peak is looked for: 0.25 to 3.75 mm.
inline constexpr std::size_t edgeDepths = 15;
inline constexpr double edgeDepth(std::size_t n) {
    return 0.25 * double(n + 1);
}

/// HU as shares of the step from gas (0) to the wall's tissue (1).
struct EdgeScale {
    double gasHu = 0.0, stepHu = 1.0;
    double shareOf(double hu) const { return (hu - gasHu) / stepHu; }
};
EdgeScale edgeScale(const PreparedColon& colon, const WallEvidence& evidence);

/// In the median of the lines, as shares of that step, of the cleansed scan as it is.
struct WallEdges {
    double rise = 0.0;  ///< from half a millimetre before the surface to as much behind
    double peak = 0.0;  ///< the greatest at those depths; over 1 where an edge is enhanced
};
/// None where too little of the wall is dry to tell.
std::optional<WallEdges> wallEdges(const PreparedColon& colon, const WallEvidence& evidence);

/// Scans as they come have peaks of 0.92 to 0.97, as fat lies behind most of the wall. Tissue alone
/// behind it makes 1, and more is the kernel's.
inline constexpr double usualPeak = 0.95, sharpPeak = 1.0;

/// A warning for readers of a scan whose edges are unlike those that detection has learnt from, as
/// they came and as it looks at them (`softened`; none where nothing was taken off). A kernel that
/// enhances edges makes the wall behind gas brighter than its tissue, and half of all polyps are
/// missed; so it is where contrast or a film makes the wall's surface bright. Where edges are
/// blurred by a standard deviation over 1.6 mm, small polyps are lost and residue is told as
/// polyps. None of others.
std::optional<std::string> warningOfEdges(const WallEdges& edges,
                                          const std::optional<WallEdges>& softened);

}  // namespace haustra::cad
