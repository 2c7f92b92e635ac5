// What the client knows of a case.
#pragma once

#include "core/centerline.h"
#include "core/colon_record.h"
#include "core/grid.h"
#include "core/histogram.h"
#include "core/optics_preset.h"
#include "core/view.h"
#include "reader/flat_strip.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::reader {

/// Whether the case has findings: none, some, or some that cannot be read.
enum class Detection { none, there, damaged };

struct CaseInfo {
    std::string name;
    std::string scan;  ///< which the case is of; bookmarks belong to it
    Grid grid;
    Centerline centerline;
    PatientPosition position = PatientPosition::unknown;
    std::vector<OpticsPreset> presets;  ///< one at least, the default first
    Histogram histogram;                ///< of the scan; may be empty
    bool cleansed = false;              ///< there is a cleansed scan
    std::optional<ColonTrust> trust;    ///< how sure the colon is, where one was searched for
    std::optional<FlatStrip> flat;      ///< where the case has been flattened
    Detection detection = Detection::none;
};

/// A case of the server's list. An old server tells its name alone.
struct CaseEntry {
    enum class State {
        unknown,     ///< not told
        ready,       ///< it can be opened
        incomplete,  ///< there is no scan in it yet
        damaged,     ///< it cannot be opened
    };
    std::string name;
    State state = State::unknown;
    std::string reason;       ///< a sentence: why it is not ready
    std::string preparedUtc;  ///< when a product of it was last published, as of a bookmark
    glm::ivec3 size{0};       ///< of the scan, voxels
    glm::dvec3 spacingMm{0.0};
    bool cleansed = false, flattened = false;
    std::optional<double> confidence;  ///< 0…1, where a colon was searched for
    int warnings = 0, bookmarks = 0;
    int readers = 0;  ///< sessions that had it open when the list was made
    bool operator==(const CaseEntry&) const = default;
};

struct Bookmark {
    std::uint64_t id = 0;  ///< the server's number; 0 until it acknowledged
    Camera camera;         ///< a place and a gaze; its lens means nothing
    double arcMm = 0.0;
    std::string note, createdUtc;
    /// The place of the wall that it means, where the server has told it.
    std::optional<WallPlace> mark;
    std::string clientKey;  ///< chosen by the client: the same bookmark sent twice is kept once
    bool acknowledged() const { return id != 0; }
};

/// One of the server's presets by its name, or optics of one's own.
using OpticsChoice = std::variant<std::string, Optics>;

}  // namespace haustra::reader
