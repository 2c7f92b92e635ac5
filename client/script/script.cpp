#include "script/script.h"

#include "core/flat_map.h"
#include "core/printed_text.h"
#include "protocol/limits.h"
#include "reader/biopsy_lens.h"
#include "reader/flight.h"
#include "script/fields.h"

#include <algorithm>

namespace haustra::reader {
namespace {

using nlohmann::json;

constexpr double maxArcMm = 1e5, maxHoldMs = 60'000.0;

ViewAction readView(Fields& in) {
    ViewAction action;
    if (in.has("viewport")) action.viewport = in.viewport();
    action.view = in.view("view");
    if (in.has("size")) {
        const glm::ivec2 size = in.size("size");
        action.width = size.x;
        action.height = size.y;
    }
    return action;
}

GoAction readGo(Fields& in) {
    GoAction action;
    if (in.has("arc_mm")) action.arcMm = in.number("arc_mm", 0.0, maxArcMm);
    if (in.has("fraction")) action.fraction = in.number("fraction", 0.0, 1.0);
    if (action.arcMm && action.fraction)
        Fields::refuse("fraction", "and \"arc_mm\" exclude each other");
    if (in.has("direction")) {
        const std::string text = in.text("direction");
        if (text == "antegrade")
            action.direction = FlightDirection::antegrade;
        else if (text == "retrograde")
            action.direction = FlightDirection::retrograde;
        else
            Fields::refuse("direction", "must be antegrade or retrograde");
    }
    if (in.has("yaw_deg")) action.yawDegrees = in.number("yaw_deg", -360.0, 360.0);
    if (in.has("pitch_deg"))
        action.pitchDegrees =
            in.number("pitch_deg", -Flight::maxPitchDegrees, Flight::maxPitchDegrees);
    if (in.has("lens")) {
        const std::string text = in.text("lens");
        if (text != "perspective" && text != "fisheye")
            Fields::refuse("lens", "must be perspective or fisheye");
        action.fisheye = text == "fisheye";
    }
    if (in.has("fov_deg"))
        action.fovDegrees = in.number("fov_deg", 10.0, action.fisheye.value_or(false) ? 240 : 150);
    return action;
}

FlyAction readFly(Fields& in) {
    FlyAction action;
    if (in.has("from_mm")) action.fromMm = in.number("from_mm", 0.0, maxArcMm);
    if (in.has("to_mm")) action.toMm = in.number("to_mm", 0.0, maxArcMm);
    if (in.has("positions")) action.positions = in.integer("positions", 2, 100'000);
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("pipelined")) action.pipelined = in.flag("pipelined");
    if (in.has("hold_ms")) action.holdMs = in.number("hold_ms", 0.0, maxHoldMs);
    return action;
}

StillAction readStill(Fields& in) {
    StillAction action;
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("png")) action.png = in.fileName("png", ".png");
    if (in.has("hold_ms")) action.holdMs = in.number("hold_ms", 0.0, maxHoldMs);
    return action;
}

LensAction readLens(Fields& in) {
    LensAction action;
    if (in.has("at")) {
        const auto at = in.numbers("at", 2, -2.0, 2.0);
        action.at = glm::dvec2(at[0], at[1]);
    }
    if (in.has("position_mm")) action.positionMm = in.position("position_mm");
    if (action.at && action.positionMm)
        Fields::refuse("position_mm", "and \"at\" exclude each other");
    if (in.has("radius")) action.radius = in.number("radius", leastLensRadius, greatestLensRadius);
    if (in.has("preset")) action.preset = in.text("preset");
    if (in.has("png")) action.png = in.fileName("png", ".png");
    return action;
}

SliceAction readSlice(Fields& in) {
    SliceAction action;
    action.view = in.view("view");
    if (!isSlice(action.view)) Fields::refuse("view", "must be axial, coronal or sagittal");
    if (in.has("position_mm")) action.positionMm = in.position("position_mm");
    if (in.has("zoom")) action.zoom = in.number("zoom", 1.0, maxSliceZoom);
    if (in.has("cleansed")) action.cleansed = in.flag("cleansed");
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("size")) action.size = in.size("size");
    if (in.has("png")) action.png = in.fileName("png", ".png");
    return action;
}

FlatAction readFlat(Fields& in) {
    FlatAction action;
    if (in.has("center")) action.center = in.flat("center");
    if (in.has("arc_mm")) action.arcMm = in.number("arc_mm", 0.0, maxArcMm);
    if (action.center && action.arcMm)
        Fields::refuse("arc_mm", "and \"center\" exclude each other");
    if (in.has("pixels_per_circumference"))
        action.pixelsPerCircumference =
            in.number("pixels_per_circumference", protocol::minPixelsPerCircumference,
                      protocol::maxPixelsPerCircumference);
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("size")) action.size = in.size("size");
    if (in.has("png")) action.png = in.fileName("png", ".png");
    if (in.has("hold_ms")) action.holdMs = in.number("hold_ms", 0.0, maxHoldMs);
    return action;
}

ObliqueAction readOblique(Fields& in) {
    ObliqueAction action;
    if (in.has("position_mm")) action.positionMm = in.position("position_mm");
    if (in.has("forward")) action.forward = in.position("forward");
    if (in.has("up")) action.up = in.position("up");
    if (action.forward.has_value() != action.up.has_value())
        Fields::refuse("up", "and \"forward\" go together");
    if (action.forward && !(glm::length(glm::cross(*action.forward, *action.up)) > 0.0))
        Fields::refuse("up", "is along \"forward\"");
    if (in.has("ahead_mm")) action.aheadMm = in.number("ahead_mm", -1000.0, 1000.0);
    if (in.has("height_mm")) action.heightMm = in.number("height_mm", minObliqueMm, maxObliqueMm);
    if (in.has("cleansed")) action.cleansed = in.flag("cleansed");
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("size")) action.size = in.size("size");
    if (in.has("png")) action.png = in.fileName("png", ".png");
    return action;
}

OverviewAction readOverview(Fields& in) {
    OverviewAction action;
    if (in.has("azimuth_deg")) action.azimuthDegrees = in.number("azimuth_deg", -360.0, 360.0);
    if (in.has("elevation_deg")) action.elevationDegrees = in.number("elevation_deg", -90.0, 90.0);
    if (in.has("height_mm")) action.heightMm = in.number("height_mm", 1.0, 5000.0);
    if (in.has("reader")) action.reader = in.flag("reader");
    if (in.has("bookmarks")) action.bookmarks = in.flag("bookmarks");
    if (in.has("body")) action.body = in.flag("body");
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("size")) action.size = in.size("size");
    if (in.has("png")) action.png = in.fileName("png", ".png");
    return action;
}

StripAction readStrip(Fields& in) {
    StripAction action;
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("size")) action.size = in.size("size");
    if (in.has("png")) action.png = in.fileName("png", ".png");
    if (in.has("hold_ms")) action.holdMs = in.number("hold_ms", 0.0, maxHoldMs);
    return action;
}

FlyOverAction readFlyOver(Fields& in) {
    FlyOverAction action;
    if (in.has("from")) action.from = in.number("from", 0.0, maxFlatHeight);
    if (in.has("to")) action.to = in.number("to", 0.0, maxFlatHeight);
    if (in.has("positions")) action.positions = in.integer("positions", 2, 100'000);
    if (in.has("pixels_per_circumference"))
        action.pixelsPerCircumference =
            in.number("pixels_per_circumference", protocol::minPixelsPerCircumference,
                      protocol::maxPixelsPerCircumference);
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("pipelined")) action.pipelined = in.flag("pipelined");
    if (in.has("endoscopic")) action.endoscopic = in.flag("endoscopic");
    if (action.endoscopic && action.viewport == 0)
        Fields::refuse("viewport", "0 shows the endoscopic view");
    if (in.has("hold_ms")) action.holdMs = in.number("hold_ms", 0.0, maxHoldMs);
    return action;
}

LocateAction readLocate(Fields& in) {
    LocateAction action;
    if (in.has("flat")) action.flat = in.flat("flat");
    if (in.has("position_mm")) action.positionMm = in.position("position_mm");
    if (action.flat.has_value() == action.positionMm.has_value())
        Fields::refuse("flat", "or \"position_mm\" is needed, not both");
    if (in.has("json")) action.json = in.fileName("json", ".json");
    return action;
}

MeasureAction readMeasure(Fields& in) {
    MeasureAction action;
    if (in.has("closed")) action.closed = in.flag("closed");
    action.points =
        in.flats("flat", action.closed ? protocol::minOutlinePoints : protocol::minLinePoints,
                 protocol::maxMeasuredPoints);
    if (in.has("json")) action.json = in.fileName("json", ".json");
    return action;
}

PaintAction readPaint(Fields& in) {
    PaintAction action;
    if (in.has("marks")) action.paint.marks = in.flag("marks");
    if (in.has("unseen")) action.paint.unseen = in.flag("unseen");
    if (in.has("radius_mm"))
        action.paint.markRadiusMm = in.number("radius_mm", minMarkRadiusMm, maxMarkRadiusMm);
    return action;
}

SeenAction readSeen(Fields& in) {
    SeenAction action;
    if (in.has("forget")) action.forget = in.flag("forget");
    if (in.has("json")) action.json = in.fileName("json", ".json");
    return action;
}

SeenLimitsAction readSeenLimits(Fields& in) {
    SeenLimitsAction action;
    if (in.has("pixels_per_mm"))
        action.limits.pixelsPerMm =
            in.number("pixels_per_mm", leastSeenPixelsPerMm, mostSeenPixelsPerMm);
    if (in.has("least_ms")) action.limits.leastMs = in.integer("least_ms", 0, mostSeenMs);
    return action;
}

// Of which patches.
double readLeastMm2(Fields& in) {
    return in.has("least_mm2")
               ? in.number("least_mm2", protocol::leastListedMm2, protocol::mostListedMm2)
               : leastMissedMm2;
}

MissedAction readMissed(Fields& in) {
    MissedAction action{readLeastMm2(in), {}};
    if (in.has("json")) action.json = in.fileName("json", ".json");
    return action;
}

NextMissedAction readNextMissed(Fields& in) {
    NextMissedAction action;
    if (in.has("step")) action.step = in.integer("step", -1, 1);
    if (action.step == 0) Fields::refuse("step", "must be 1 or -1");
    return action;
}

LedgerAction readLedger(Fields& in) {
    return {in.fileName("json", ".json")};
}

SeenReportAction readSeenReport(Fields& in) {
    SeenReportAction action{readLeastMm2(in), {}};
    if (in.has("json")) action.json = in.fileName("json", ".json");
    return action;
}

DetectionAction readDetection(Fields& in) {
    DetectionAction action;
    const std::string mode = in.text("mode");
    if (mode == "off")
        action.choice.mode = DetectionMode::off;
    else if (mode == "second-reader")
        action.choice.mode = DetectionMode::secondReader;
    else if (mode == "concurrent")
        action.choice.mode = DetectionMode::concurrent;
    else
        Fields::refuse("mode", "must be off, second-reader or concurrent");
    if (in.has("first_pass_done")) action.choice.firstPassDone = in.flag("first_pass_done");
    if (in.has("least_probability"))
        action.choice.leastProbability = in.number("least_probability", 0.0, 1.0);
    return action;
}

FindingsAction readFindings(Fields& in) {
    FindingsAction action;
    if (in.has("json")) action.json = in.fileName("json", ".json");
    return action;
}

FindingAction readFinding(Fields& in) {
    return {in.integer("number", 1, 1'000'000)};
}

WindowAction readWindow(Fields& in) {
    WindowAction action;
    if (in.has("viewport")) action.viewport = in.viewport();
    action.window.centerHu = in.number("center_hu", -5000.0, 5000.0);
    action.window.widthHu = in.number("width_hu", 1.0, 10'000.0);
    return action;
}

TransferAction readTransfer(Fields& in) {
    TransferAction action;
    if (in.has("viewport")) action.viewport = in.viewport();
    const bool preset = in.has("preset"), points = in.has("points"), optics = in.has("optics"),
               file = in.has("file");
    if (preset + points + optics + file != 1)
        Fields::refuse("preset", "or \"points\", \"optics\" or \"file\" is needed, one of them");
    if (preset) action.optics = in.text("preset");
    if (points) action.optics = in.opticsOfPoints("points");
    if (optics) action.optics = in.opticsOfObject("optics");
    if (file) action.optics = in.opticsOfFile("file");
    return action;
}

BookmarkAction readBookmark(Fields& in) {
    BookmarkAction action;
    if (in.has("note")) action.note = in.text("note", protocol::maxNoteBytes);
    if (in.has("count")) action.count = in.integer("count", 1, 1'000'000);
    return action;
}

BookmarksAction readBookmarks(Fields& in) {
    BookmarksAction action;
    if (in.has("json")) action.json = in.fileName("json", ".json");
    return action;
}

WaitAction readWait(Fields& in) {
    return {in.number("ms", 0.0, 3'600'000.0)};
}

struct ActionKind {
    const char* name;
    ActionBody (*read)(Fields& in);
};

// Any of the readers above, as one that reads whatever action.
template <auto read>
ActionBody bodyBy(Fields& in) {
    return read(in);
}

constexpr ActionKind actionKinds[] = {
    {"view", bodyBy<readView>},
    {"go", bodyBy<readGo>},
    {"fly", bodyBy<readFly>},
    {"still", bodyBy<readStill>},
    {"slice", bodyBy<readSlice>},
    {"oblique", bodyBy<readOblique>},
    {"overview", bodyBy<readOverview>},
    {"flat", bodyBy<readFlat>},
    {"strip", bodyBy<readStrip>},
    {"flyover", bodyBy<readFlyOver>},
    {"locate", bodyBy<readLocate>},
    {"measure", bodyBy<readMeasure>},
    {"paint", bodyBy<readPaint>},
    {"seen", bodyBy<readSeen>},
    {"seen-limits", bodyBy<readSeenLimits>},
    {"missed", bodyBy<readMissed>},
    {"next-missed", bodyBy<readNextMissed>},
    {"ledger", bodyBy<readLedger>},
    {"seen-report", bodyBy<readSeenReport>},
    {"detection", bodyBy<readDetection>},
    {"findings", bodyBy<readFindings>},
    {"finding", bodyBy<readFinding>},
    {"window", bodyBy<readWindow>},
    {"transfer", bodyBy<readTransfer>},
    {"bookmark", bodyBy<readBookmark>},
    {"bookmarks", bodyBy<readBookmarks>},
    {"wait", bodyBy<readWait>},
    {"lens", bodyBy<readLens>},
};

Action readAction(const std::string& line) {
    const json object = json::parse(line, nullptr, false);
    if (!object.is_object()) throw ScriptRefusal{"not a JSON object"};
    Fields in(object);
    Action action;
    action.name = in.text("do");
    const auto kind = std::ranges::find(actionKinds, action.name, &ActionKind::name);
    if (kind == std::end(actionKinds))
        throw ScriptRefusal{"no such action: \"" + action.name + "\" (" + scriptActionNames() +
                            ")"};
    action.body = kind->read(in);
    in.allMustBeKnown();
    return action;
}

}  // namespace

std::string scriptActionNames() {
    std::string all;
    for (const ActionKind& kind : actionKinds)
        all += (all.empty() ? "" : ", ") + std::string(kind.name);
    return all;
}

Result<std::vector<Action>> parseScript(std::istream& in, const std::string& name) {
    std::vector<Action> actions;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        const std::size_t start = line.find_first_not_of(" \t\r");
        if (start == std::string::npos || line[start] == '#') continue;
        try {
            actions.push_back(readAction(line));
            actions.back().line = number;
        } catch (const ScriptRefusal& refusal) {
            return fail(ErrorKind::badInput, refusal.message, name + ":" + std::to_string(number));
        } catch (const json::exception& error) {
            return fail(ErrorKind::badInput, reasonOf(error), name + ":" + std::to_string(number));
        }
    }
    return actions;
}

}  // namespace haustra::reader
