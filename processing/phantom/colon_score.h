// How near the colon that was found comes to the true one as a chain: what it took that is none,
// which of it has a path, and which steps of it truth does not have.
#pragma once

#include "core/colon_record.h"
#include "phantom/phantom.h"

#include <string>
#include <vector>

namespace haustra::phantom {

/// A step of the chain, or of the path, that truth does not have, or one that it lacks.
struct WrongStep {
    enum class Kind {
        foreign,     ///< into or out of what is no colon
        leap,        ///< between stretches whose arcs are no neighbours
        bridge,      ///< through tissue where the true lumen is open and shows
        notBridged,  ///< a true collapse that no step crosses
        pathLeap,    ///< as leap, of the path alone
    };
    Kind kind = Kind::leap;
    glm::dvec3 placeMm{0.0};
    double fromArcMm = 0.0, toArcMm = 0.0;  ///< true arcs on its two sides; −1 outside the colon
    bool warned = false;                    ///< a warning names a place within kWarnedWithinMm
};
/// "foreign", "leap" …
const char* toString(WrongStep::Kind kind);

struct ColonScore {
    /// Found more than kFalseBeyondMm from any lumen (LumenScore::falseMl), by what is there.
    double falseIleumMl = 0.0, falseOtherBowelMl = 0.0, falseElsewhereMl = 0.0;
    double trueMm = 0.0;  ///< of the true axis
    double openMm = 0.0;  ///< of that, what is no gap
    /// Of the open axis: what no sample of the path comes as near to as the true radius is there,
    /// or 5 mm where it is narrower.
    double missedMm = 0.0;
    double pathMm = 0.0;   ///< of the path that was found
    double wrongMm = 0.0;  ///< of it, outside the true lumen and on no true collapse
    double coverage() const { return openMm > 0.0 ? 1.0 - missedMm / openMm : 0.0; }
    int collapses = 0, collapsesCrossed = 0;  ///< true ones; and those a right step crosses
    int bridges = 0;                          ///< steps through tissue that were found
    std::vector<WrongStep> wrongSteps;
};

inline constexpr double kWarnedWithinMm = 40.0;

/// The true lumen's voxels are told apart by the sample of the axis that is nearest inside the
/// lumen, so that loops that touch have different arcs. A collapse is where the axis passes from
/// one 6-connected part of the true lumen (0.5 ml or more) to the next; fluid without tagging over
/// 3 mm of the axis shows no lumen either, and may be bridged. A step is wrong where its arcs are
/// farther apart than twice the way between the pieces' centres and 20 mm.
/// `lumen` is the LumenLabel volume that was found, on the phantom's grid; `warnings` what the
/// reader is told, places as "(x, y, z) mm". O(voxels + samples of path × of axis).
ColonScore scoreColon(const Phantom& truth, const Volume<std::uint8_t>& lumen,
                      const Centerline& path, const ColonRecord& record,
                      const std::vector<std::string>& warnings);

}  // namespace haustra::phantom
