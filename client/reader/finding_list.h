// The findings of a case as the server lists them.
#pragma once

#include "core/camera.h"
#include "core/findings.h"
#include "reader/flat_strip.h"

#include <optional>
#include <string>
#include <vector>

namespace haustra::reader {

struct ListedFinding {
    int number = 0;          ///< in the case, from 1: the same whatever else is listed
    bool candidate = false;  ///< below the operating point
    /// Its score is the probability. Features are not told, and voxels where the list had room.
    Finding finding;
    WallPlace wall;  ///< at its top
    /// That shows it, where a look from the path at the wall's arc does not.
    std::optional<Camera> view = {};
};

/// Whether both are one finding of one search: a case that is searched anew may number another
/// place alike.
inline bool isSame(const ListedFinding& a, const ListedFinding& b) {
    return a.number == b.number && a.wall.positionMm == b.wall.positionMm &&
           a.finding.diameterEndsMm == b.finding.diameterEndsMm;
}

struct FindingList {
    enum class State {
        none,       ///< the case has none
        damaged,    ///< they cannot be read
        off,        ///< the mode hides them
        firstPass,  ///< so does the mode, until the first reading is done
        shown,
    };
    State state = State::none;
    double operatingPoint = 0.0;  ///< probability from which on one is no candidate
    std::string model, trainedOn;
    std::vector<std::string> warnings;
    std::vector<ListedFinding> findings;  ///< along the colon
};

}  // namespace haustra::reader
