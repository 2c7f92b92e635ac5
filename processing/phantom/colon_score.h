// How near the colon that was found, as a chain of pieces, comes to the true one: what was taken
// for colon that is none, how much of the colon has a path, and which steps between pieces are
// wrong.
#pragma once

#include "core/colon_record.h"
#include "phantom/phantom.h"

#include <string>
#include <vector>

namespace haustra::phantom {

/// A wrong step from one piece of the chain, or one place of the path, to the next; or a step that
/// is missing.
struct WrongStep {
    enum class Kind {
        foreign,  ///< into or out of what is no colon
        leap,     ///< from one stretch of colon to another that does not follow it
        bridge,   ///< through tissue, where the true lumen is open and filled with gas or tagging
        notBridged,  ///< missing: the true colon is collapsed there, and no step crosses it
        pathLeap,    ///< a leap that the path makes and the chain does not
    };
    Kind kind = Kind::leap;
    glm::dvec3 placeMm{0.0};
    double fromArcMm = 0.0, toArcMm = 0.0;  ///< true arcs on its two sides; −1 outside the colon
    bool warned = false;                    ///< a warning names a place within warnedWithinMm
};
/// "foreign", "leap" …
const char* toString(WrongStep::Kind kind);

struct ColonScore {
    /// Volume found more than falseBeyondMm from the true lumen (LumenScore::falseMl), by what it
    /// is in truth.
    double falseIleumMl = 0.0, falseOtherBowelMl = 0.0, falseElsewhereMl = 0.0;
    double trueMm = 0.0;  ///< length of the true axis
    double openMm = 0.0;  ///< of that, the length that is no gap
    /// Of openMm, the length that the path misses: no sample of the path is within the true radius
    /// there (at least 5 mm) of it.
    double missedMm = 0.0;
    double pathMm = 0.0;   ///< length of the path that was found
    double wrongMm = 0.0;  ///< of that, the length outside the true lumen and on no true collapse
    double coverage() const { return openMm > 0.0 ? 1.0 - missedMm / openMm : 0.0; }
    int collapses = 0, collapsesCrossed = 0;  ///< true ones; those that a right step crosses
    int bridges = 0;                          ///< steps through tissue that were found
    std::vector<WrongStep> wrongSteps;
};

inline constexpr double warnedWithinMm = 40.0;

/// A voxel of the true lumen has the arc of the sample of the axis that is nearest by a way inside
/// the lumen, so that two loops that touch have different arcs. A collapse is where the axis passes
/// from one 6-connected part of the true lumen (0.5 ml or more) to the next; fluid without tagging
/// over 3 mm of the axis shows no lumen either, and may be bridged. A step is wrong where its arcs
/// are farther apart than twice the way between the pieces' centres and 20 mm. `lumen` is the
/// LumenLabel volume that was found, on the phantom's grid; `warnings` what the reader is told,
/// places as "(x, y, z) mm". O(voxels + samples of path × of axis).
ColonScore scoreColon(const Phantom& truth, const Volume<std::uint8_t>& lumen,
                      const Centerline& path, const ColonRecord& record,
                      const std::vector<std::string>& warnings);

}  // namespace haustra::phantom
