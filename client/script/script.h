// Scripts of the headless client: one JSON object a line. client/SCRIPT.md describes the actions.
#pragma once

#include "core/detection_choice.h"
#include "core/seen_limits.h"
#include "reader/case_info.h"
#include "reader/lens_view.h"

#include <istream>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace haustra::reader {

struct ViewAction {
    int viewport = 0;
    View view = View::endoscopic;
    int width = 512, height = 512;
};
struct GoAction {
    std::optional<double> arcMm, fraction;  ///< at most one; neither: stay
    std::optional<FlightDirection> direction;
    std::optional<double> yawDegrees, pitchDegrees, fovDegrees;
    std::optional<bool> fisheye;
};
struct FlyAction {
    std::optional<double> fromMm, toMm;  ///< default: the whole centerline, in flight direction
    int positions = 200;
    int viewport = 0;
    bool pipelined = false;
    double holdMs = 0.0;  ///< each picture stays on screen for so long
};
struct StillAction {
    int viewport = 0;
    std::string png;      ///< may be empty: only wait for the picture
    double holdMs = 0.0;  ///< as of FlyAction
};
struct LensAction {
    std::optional<glm::dvec2> at;          ///< heights of the picture from its middle
    std::optional<glm::dvec3> positionMm;  ///< at most one of both; neither: in its middle
    double radius = LensPlace{}.radius;
    std::optional<std::string> preset;  ///< default: the case's electronic biopsy
    std::string png;
};
struct SliceAction {
    View view = View::axial;
    std::optional<glm::dvec3> positionMm;  ///< default: where the camera is
    double zoom = 1.0;
    bool cleansed = false;
    std::optional<int> viewport;  ///< default: 1 axial, 2 coronal, 3 sagittal
    std::optional<glm::ivec2> size;
    std::string png;
};
struct FlatAction {
    std::optional<glm::dvec2> center;  ///< in circumferences
    std::optional<double> arcMm;       ///< at most one of both; neither: around the camera
    std::optional<double> pixelsPerCircumference;  ///< default: all around fits
    int viewport = int(View::flattenedZoom);
    std::optional<glm::ivec2> size;
    std::string png;
    double holdMs = 0.0;  ///< as of FlyAction
};
struct ObliqueAction {
    std::optional<glm::dvec3> positionMm;   ///< default: where the camera is
    std::optional<glm::dvec3> forward, up;  ///< default: the camera's; both or neither
    double aheadMm = 0.0;                   ///< moved along forward
    double heightMm = ObliqueView{}.heightMm;
    bool cleansed = false;
    int viewport = int(View::oblique);
    std::optional<glm::ivec2> size;
    std::string png;
};
struct OverviewAction {
    double azimuthDegrees = 0.0, elevationDegrees = 0.0;
    std::optional<double> heightMm;  ///< default: all of the colon
    bool reader = true, bookmarks = true, body = true;
    int viewport = int(View::overview);
    std::optional<glm::ivec2> size;
    std::string png;
};
struct StripAction {
    int viewport = int(View::flattened);
    std::optional<glm::ivec2> size;
    std::string png;
    double holdMs = 0.0;  ///< as of FlyAction
};
struct FlyOverAction {
    std::optional<double> from, to;  ///< circumferences; default: the whole strip
    int positions = 200;
    std::optional<double> pixelsPerCircumference;
    int viewport = int(View::flattenedZoom);
    bool pipelined = false;
    bool endoscopic = false;  ///< the endoscopic view follows, in viewport 0
    double holdMs = 0.0;      ///< as of FlyAction
};
struct LocateAction {
    std::optional<glm::dvec2> flat;
    std::optional<glm::dvec3> positionMm;  ///< exactly one of both
    std::string json;
};
struct MeasureAction {
    std::vector<glm::dvec2> points;
    bool closed = false;
    std::string json;
};
struct DetectionAction {
    DetectionChoice choice;
};
struct FindingsAction {
    std::string json;
};
struct FindingAction {
    int number = 1;
};
struct WindowAction {
    int viewport = 1;
    WindowLevel window;
};
struct TransferAction {
    int viewport = 0;
    OpticsChoice optics;
};
struct PaintAction {
    WallPaintChoice paint;
};
struct SeenAction {
    bool forget = false;
    std::string json;
};
struct SeenLimitsAction {
    SeenLimits limits;
};
struct MissedAction {
    double leastMm2 = leastMissedMm2;
    std::string json;
};
struct NextMissedAction {
    int step = 1;  ///< −1: the one before
};
struct LedgerAction {
    std::string json;
};
struct SeenReportAction {
    double leastMm2 = leastMissedMm2;
    std::string json;
};
struct BookmarkAction {
    std::string note;
    int count = 1;  ///< added one after the other, each acknowledged before the next
};
struct BookmarksAction {
    std::string json;  ///< file for the list; may be empty
};
struct WaitAction {
    double ms = 0.0;
};

using ActionBody =
    std::variant<ViewAction, GoAction, FlyAction, StillAction, LensAction, SliceAction,
                 ObliqueAction, OverviewAction, FlatAction, StripAction, FlyOverAction,
                 LocateAction, MeasureAction, PaintAction, SeenAction, SeenLimitsAction,
                 MissedAction, NextMissedAction, LedgerAction, SeenReportAction, DetectionAction,
                 FindingsAction, FindingAction, WindowAction, TransferAction, BookmarkAction,
                 BookmarksAction, WaitAction>;

struct Action {
    int line = 0;
    std::string name;  ///< the value of "do"
    ActionBody body;
};

/// "view, go, …": what "do" can be.
std::string scriptActionNames();

/// Reads a whole script. Blank lines and lines that start with '#' are skipped. Fails on the first
/// line that is not understood: the place is `name` and the line's number, the message names the
/// key. Output files must be plain names: a script writes only into its output folder.
Result<std::vector<Action>> parseScript(std::istream& in, const std::string& name);

}  // namespace haustra::reader
