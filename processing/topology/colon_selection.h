// Which of the bowel's gas and fluid is colon.
#pragma once

#include "core/volume.h"
#include "topology/air_fluid.h"
#include "topology/pools.h"
#include "topology/run_components.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace haustra::topology {

/// Air components and pools that levels join: one piece of bowel, or of stomach.
struct BowelPiece {
    std::vector<int> air;    ///< components
    std::vector<int> pools;  ///< indices
    double airMl = 0.0, taggedMl = 0.0;
    glm::dvec3 centroidMm{0.0};
    double lowestMm = 0.0, highestMm = 0.0;  ///< extent along the patient's z
    double lengthMm = 0.0;                   ///< from end to end, through the piece
    glm::dvec3 endMm[2]{};                   ///< its two ends
    double volumeMl() const { return airMl + taggedMl; }
    /// Mean diameter of a tube of this volume and length.
    double calibreMm() const;
    /// Lengths of its calibre from end to end: a long tube, or a bubble.
    double elongation() const { return lengthMm / std::max(1.0, calibreMm()); }
};

/// Joins the air components that `bowelAir` marks through the pools, and measures each piece.
std::vector<BowelPiece> bowelPieces(const Volume<std::int16_t>& hu, const RunComponents& air,
                                    const std::vector<char>& bowelAir,
                                    const std::vector<Level>& levels,
                                    const std::vector<Pool>& pools, double smallestMl);

/// Indices of the pieces that are colon. `chosen` are pieces that a person named. The colon is the
/// longest wide tube, the other wide tubes that reach the lower abdomen, and the pieces that lie
/// in a gap between their ends; the stomach is a bubble high in the abdomen that bridges nothing,
/// and small-bowel gas is narrow or short.
std::vector<int> selectColon(const std::vector<BowelPiece>& pieces, const std::vector<int>& chosen);

}  // namespace haustra::topology
