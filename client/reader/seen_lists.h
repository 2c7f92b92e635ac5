// What the server tells of the wall that has been seen, and that has not.
#pragma once

#include "core/camera.h"
#include "core/seen_limits.h"
#include "reader/flat_strip.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace haustra::reader {

/// A patch of wall that has not been seen.
struct MissedPlace {
    double areaMm2 = 0.0;
    WallPlace place;             ///< its middle
    std::optional<Camera> view;  ///< that shows most of it
};

struct MissedList {
    double share = 0.0;  ///< of the wall that has been seen
    double leastMm2 = leastMissedMm2;
    int count = 0;  ///< of all so large, and their area
    double areaMm2 = 0.0;
    std::vector<MissedPlace> patches;  ///< the largest first, as many as the server lists
};

/// What has been seen, triangle by triangle of the flattened surface: 0 or 1 each.
struct LedgerFlags {
    std::string wall;  ///< names the surface by its content
    SeenLimits limits;
    double share = 0.0;
    bool recorded = false;
    std::vector<std::uint8_t> shown;  ///< on screen for long enough
    std::vector<std::uint8_t> seen;   ///< and single ones between them
};

struct ReaderSeen {
    std::string reader;  ///< empty: this session's, which is not recorded
    SeenLimits limits;
    double share = 0.0;
    std::string changedUtc;
    MissedList missed;
};

/// What has been seen of a wall, by whom.
struct SeenReport {
    std::string wall;
    double leastMm2 = leastMissedMm2;
    std::vector<ReaderSeen> readers;  ///< who read last first
};

}  // namespace haustra::reader
