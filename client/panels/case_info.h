// What the client knows of a case: the nouns that cross the protocol, in the client's own types.
#pragma once

#include "core/centerline.h"
#include "core/grid.h"
#include "panels/flat_strip.h"
#include "panels/flight.h"

#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::panels {

/// Shortest side of a picture that a server draws.
inline constexpr int minViewportPixels = 16;

/// The whole flattened strip, and a window onto it, are views of cases that have been flattened.
enum class View { endoscopic, axial, coronal, sagittal, flattened, flattenedZoom };
inline constexpr int viewCount = 6;
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

struct WindowLevel {
    double centerHu = 0.0, widthHu = 2000.0;
    bool operator==(const WindowLevel&) const = default;
};

struct CaseInfo {
    std::string name;
    Grid grid;
    Centerline centerline;
    PatientPosition position = PatientPosition::unknown;
    std::vector<std::string> transferFunctions;
    bool cleansed = false;          ///< there is a cleansed scan
    std::optional<FlatStrip> flat;  ///< where the case has been flattened
};

struct Bookmark {
    std::uint64_t id = 0;  ///< the server's number; 0 until it acknowledged
    Camera camera;
    double arcMm = 0.0;
    std::string note, createdUtc;
    std::string clientKey;  ///< chosen by the client: the same bookmark sent twice is kept once
    bool acknowledged() const { return id != 0; }
};

}  // namespace haustra::panels
