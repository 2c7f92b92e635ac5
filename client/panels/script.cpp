#include "panels/script.h"

#include "protocol/framing.h"

#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

namespace haustra::panels {
namespace {

using nlohmann::json;

// Thrown and caught in this file: what is wrong with a line, in a sentence.
struct Refusal {
    std::string message;
};

// One line's object. Remembers which keys were asked for, so that a misspelt one is not passed
// over.
class Fields {
public:
    explicit Fields(const json& object) : object_(object) { asked_.insert("do"); }

    bool has(const char* key) {
        asked_.insert(key);
        return object_.contains(key);
    }
    double number(const char* key, double low, double high) {
        const double value = get<double>(key, &json::is_number, "a number");
        if (!(value >= low && value <= high)) refuse(key, "must lie in " + span(low, high));
        return value;
    }
    int integer(const char* key, int low, int high) {
        const auto value = get<std::int64_t>(key, &json::is_number_integer, "a whole number");
        if (value < low || value > high) refuse(key, "must lie in " + span(low, high));
        return int(value);
    }
    std::string text(const char* key, std::size_t maxBytes = 1000) {
        auto value = get<std::string>(key, &json::is_string, "a text");
        if (value.size() > maxBytes)
            refuse(key, "is longer than " + std::to_string(maxBytes) + " bytes");
        return value;
    }
    bool flag(const char* key) { return get<bool>(key, &json::is_boolean, "true or false"); }
    std::string fileName(const char* key, const char* extension) {
        std::string value = text(key, 200);
        const bool plain =
            value.find_first_of(std::string("/\\\0", 3)) == std::string::npos && value[0] != '.';
        if (!plain || !value.ends_with(extension))
            refuse(key, std::string("must be a plain file name ending in ") + extension);
        return value;
    }
    std::vector<double> numbers(const char* key, std::size_t count, double low, double high) {
        asked_.insert(key);
        const json& list = at(key);
        if (!list.is_array() || list.size() != count)
            refuse(key, "must be a list of " + std::to_string(count) + " numbers");
        std::vector<double> values;
        for (const json& item : list) {
            if (!item.is_number())
                refuse(key, "must be a list of " + std::to_string(count) + " numbers");
            values.push_back(item.get<double>());
            if (!(values.back() >= low && values.back() <= high))
                refuse(key, "must hold numbers in " + span(low, high));
        }
        return values;
    }
    glm::ivec2 size(const char* key) {
        const auto values = numbers(key, 2, minViewportPixels, protocol::maxViewportPixels);
        return {int(values[0]), int(values[1])};
    }
    View view(const char* key) {
        const auto found = viewFromString(text(key));
        if (!found) refuse(key, "must be endoscopic, axial, coronal or sagittal");
        return *found;
    }
    int viewport() { return integer("viewport", 0, int(protocol::maxViewports) - 1); }

    [[noreturn]] static void refuse(const std::string& key, const std::string& what) {
        throw Refusal{"\"" + key + "\" " + what};
    }
    void allMustBeKnown() const {
        for (const auto& [key, value] : object_.items())
            if (!asked_.count(key)) throw Refusal{"\"" + key + "\" is not a key of this action"};
    }

private:
    static std::string span(double low, double high) {
        const auto text = [](double v) {
            return json(v == std::floor(v) ? json(std::int64_t(v)) : json(v)).dump();
        };
        return text(low) + "…" + text(high);
    }
    const json& at(const char* key) const {
        const auto found = object_.find(key);
        if (found == object_.end()) throw Refusal{"\"" + std::string(key) + "\" is missing"};
        return *found;
    }
    template <class T>
    T get(const char* key, bool (json::*is)() const noexcept, const char* what) {
        asked_.insert(key);
        const json& value = at(key);
        if (!(value.*is)()) refuse(key, std::string("must be ") + what);
        return value.get<T>();
    }

    const json& object_;
    std::set<std::string> asked_;
};

constexpr double maxArcMm = 1e5, maxPositionMm = 1e5;

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
    if (in.has("fov_deg")) action.fovDegrees = in.number("fov_deg", 10.0, 150.0);
    return action;
}

FlyAction readFly(Fields& in) {
    FlyAction action;
    if (in.has("from_mm")) action.fromMm = in.number("from_mm", 0.0, maxArcMm);
    if (in.has("to_mm")) action.toMm = in.number("to_mm", 0.0, maxArcMm);
    if (in.has("positions")) action.positions = in.integer("positions", 2, 100'000);
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("pipelined")) action.pipelined = in.flag("pipelined");
    return action;
}

StillAction readStill(Fields& in) {
    StillAction action;
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("png")) action.png = in.fileName("png", ".png");
    return action;
}

SliceAction readSlice(Fields& in) {
    SliceAction action;
    action.view = in.view("view");
    if (action.view == View::endoscopic)
        Fields::refuse("view", "must be axial, coronal or sagittal");
    if (in.has("position_mm")) {
        const auto p = in.numbers("position_mm", 3, -maxPositionMm, maxPositionMm);
        action.positionMm = glm::dvec3(p[0], p[1], p[2]);
    }
    if (in.has("zoom")) action.zoom = in.number("zoom", 1.0, 64.0);
    if (in.has("cleansed")) action.cleansed = in.flag("cleansed");
    if (in.has("viewport")) action.viewport = in.viewport();
    if (in.has("size")) action.size = in.size("size");
    if (in.has("png")) action.png = in.fileName("png", ".png");
    return action;
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
    action.preset = in.text("preset");
    return action;
}

BookmarkAction readBookmark(Fields& in) {
    BookmarkAction action;
    if (in.has("note")) action.note = in.text("note");
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

Action readAction(const std::string& line) {
    const json object = json::parse(line, nullptr, false);
    if (object.is_discarded()) throw Refusal{"not a JSON object"};
    if (!object.is_object()) throw Refusal{"not a JSON object"};
    Fields in(object);
    Action action;
    action.name = in.text("do");
    if (action.name == "view")
        action.body = readView(in);
    else if (action.name == "go")
        action.body = readGo(in);
    else if (action.name == "fly")
        action.body = readFly(in);
    else if (action.name == "still")
        action.body = readStill(in);
    else if (action.name == "slice")
        action.body = readSlice(in);
    else if (action.name == "window")
        action.body = readWindow(in);
    else if (action.name == "transfer")
        action.body = readTransfer(in);
    else if (action.name == "bookmark")
        action.body = readBookmark(in);
    else if (action.name == "bookmarks")
        action.body = readBookmarks(in);
    else if (action.name == "wait")
        action.body = readWait(in);
    else
        throw Refusal{"no such action: \"" + action.name + "\""};
    in.allMustBeKnown();
    return action;
}

}  // namespace

Result<std::vector<Action>> parseScript(std::istream& in, const std::string& name) {
    std::vector<Action> actions;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        const std::size_t start = line.find_first_not_of(" \t\r");
        if (start == std::string::npos || line[start] == '#') continue;
        try {
            actions.push_back(readAction(line));
            actions.back().line = number;
        } catch (const Refusal& refusal) {
            return fail(ErrorKind::badInput, refusal.message, name + ":" + std::to_string(number));
        } catch (const json::exception& error) {
            return fail(ErrorKind::badInput, error.what(), name + ":" + std::to_string(number));
        }
    }
    return actions;
}

}  // namespace haustra::panels
