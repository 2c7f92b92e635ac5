// What the client knows of a case: the nouns that cross the protocol, in the client's own types.
#pragma once

#include "core/centerline.h"
#include "core/colon_record.h"
#include "core/grid.h"
#include "core/histogram.h"
#include "core/optics_preset.h"
#include "core/orbit.h"
#include "reader/flat_strip.h"
#include "reader/flight.h"

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::reader {

/// Shortest side of a picture that a server draws.
inline constexpr int minViewportPixels = 16;

/// The whole flattened strip, and a window onto it, are views of cases that have been flattened.
/// Oblique: a slice across the gaze. Overview: the colon from outside.
enum class View {
    endoscopic,
    axial,
    coronal,
    sagittal,
    flattened,
    flattenedZoom,
    oblique,
    overview,
};
inline constexpr std::array allViews = {View::endoscopic, View::axial,     View::coronal,
                                        View::sagittal,   View::flattened, View::flattenedZoom,
                                        View::oblique,    View::overview};
inline constexpr std::size_t viewCount = allViews.size();
inline bool isSlice(View view) {
    return view == View::axial || view == View::coronal || view == View::sagittal;
}
inline bool isFlat(View view) {
    return view == View::flattened || view == View::flattenedZoom;
}
const char* toString(View view);
std::optional<View> viewFromString(const std::string& text);

/// The plane through a patient point that a slice viewport shows.
struct Slice {
    glm::dvec3 positionMm{0.0};
    double zoom = 1.0;
    bool cleansed = false;  ///< of the scan after digital cleansing
    bool operator==(const Slice&) const = default;
};

/// The plane that a camera at `positionMm` would see before it, without perspective.
struct Oblique {
    glm::dvec3 positionMm{0.0};
    glm::dvec3 forward{0.0, 0.0, 1.0}, up{0.0, -1.0, 0.0};
    double heightMm = 60.0;  ///< of the picture
    bool cleansed = false;
    bool operator==(const Oblique&) const = default;
};

/// The colon from outside, and what is marked on it.
inline constexpr std::size_t maxMarkedBookmarks = 1024;
struct Overview {
    Orbit orbit;
    std::optional<Camera> reader;
    std::vector<glm::dvec3> bookmarksMm;
    bool body = true;  ///< shows around the colon
    bool operator==(const Overview&) const = default;
};

/// What colours the wall.
struct WallPaint {
    bool marks = false;   ///< discs where bookmarks are, whoever added them
    bool unseen = false;  ///< what no endoscopic picture of this session has shown
    double markRadiusMm = 5.0;
    bool any() const { return marks || unseen; }
};

struct WindowLevel {
    double centerHu = 0.0, widthHu = 2000.0;
    bool operator==(const WindowLevel&) const = default;
};

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
};

struct Bookmark {
    std::uint64_t id = 0;  ///< the server's number; 0 until it acknowledged
    Camera camera;
    double arcMm = 0.0;
    std::string note, createdUtc;
    std::string clientKey;  ///< chosen by the client: the same bookmark sent twice is kept once
    bool acknowledged() const { return id != 0; }
};

/// One of the server's presets by its name, or optics of one's own.
using OpticsChoice = std::variant<std::string, Optics>;

}  // namespace haustra::reader
