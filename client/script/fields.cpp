#include "script/fields.h"

#include "core/flat_map.h"
#include "core/optics_preset.h"
#include "protocol/limits.h"

#include <cmath>

namespace haustra::reader {
namespace {

using nlohmann::json;

constexpr double maxPositionMm = 1e5;

std::string span(double low, double high) {
    const auto text = [](double v) {
        return json(v == std::floor(v) ? json(std::int64_t(v)) : json(v)).dump();
    };
    return text(low) + "…" + text(high);
}

}  // namespace

bool Fields::has(const char* key) {
    asked_.insert(key);
    return object_.contains(key);
}

double Fields::number(const char* key, double low, double high) {
    const double value = get<double>(key, &json::is_number, "a number");
    if (!(value >= low && value <= high)) refuse(key, "must lie in " + span(low, high));
    return value;
}

int Fields::integer(const char* key, int low, int high) {
    const auto value = get<std::int64_t>(key, &json::is_number_integer, "a whole number");
    if (value < low || value > high) refuse(key, "must lie in " + span(low, high));
    return int(value);
}

std::string Fields::text(const char* key, std::size_t maxBytes) {
    auto value = get<std::string>(key, &json::is_string, "a text");
    if (value.size() > maxBytes)
        refuse(key, "is longer than " + std::to_string(maxBytes) + " bytes");
    return value;
}

bool Fields::flag(const char* key) {
    return get<bool>(key, &json::is_boolean, "true or false");
}

std::string Fields::fileName(const char* key, const char* extension) {
    std::string value = text(key, 200);
    const bool plain =
        value.find_first_of(std::string("/\\\0", 3)) == std::string::npos && value[0] != '.';
    if (!plain || !value.ends_with(extension))
        refuse(key, std::string("must be a plain file name ending in ") + extension);
    return value;
}

std::vector<double> Fields::numbers(const char* key, std::size_t count, double low, double high) {
    asked_.insert(key);
    return numbersOf(key, at(key), count, low, high);
}

std::vector<double> Fields::numbersOf(const char* key, const json& list, std::size_t count,
                                      double low, double high) const {
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

glm::dvec2 Fields::flat(const char* key) {
    const auto values = numbers(key, 2, -maxFlatHeight, maxFlatHeight);
    return {values[0], values[1]};
}

std::vector<glm::dvec2> Fields::flats(const char* key, std::size_t least, std::size_t most) {
    asked_.insert(key);
    const json& list = at(key);
    if (!list.is_array() || list.size() < least || list.size() > most)
        refuse(key, "must be a list of " + std::to_string(least) + " to " + std::to_string(most) +
                        " pairs of numbers");
    std::vector<glm::dvec2> points;
    for (const json& item : list) {
        const auto pair = numbersOf(key, item, 2, -maxFlatHeight, maxFlatHeight);
        if (std::abs(pair[0]) > protocol::maxMeasuredTurns)
            refuse(key, "must not turn round more than 32 times");
        points.push_back({pair[0], pair[1]});
    }
    return points;
}

glm::dvec3 Fields::position(const char* key) {
    const auto p = numbers(key, 3, -maxPositionMm, maxPositionMm);
    return {p[0], p[1], p[2]};
}

Optics Fields::opticsOfPoints(const char* key) {
    asked_.insert(key);
    const json& list = at(key);
    if (!list.is_array()) refuse(key, "must be a list of [hu, red, green, blue, opacity]");
    Optics optics;
    for (const json& item : list) {
        const auto p = numbersOf(key, item, 5, lowestTransferHu, highestTransferHu);
        optics.transferFunction.points.push_back({p[0], {p[1], p[2], p[3]}, p[4]});
    }
    if (const auto sound = checkOptics(optics); !sound) refuse(key, describe(sound.error()));
    return optics;
}

Optics Fields::opticsOfObject(const char* key) {
    asked_.insert(key);
    json object = at(key);
    if (!object.is_object()) refuse(key, "must be an object, as a preset's file has it");
    object.emplace("name", "own");
    const auto preset = parsePreset(object.dump(), "");
    if (!preset) refuse(key, "is no preset: " + describe(preset.error()));
    return preset->optics;
}

Optics Fields::opticsOfFile(const char* key) {
    const auto preset = readPresetFile(text(key));
    if (!preset) refuse(key, "is no preset's: " + describe(preset.error()));
    return preset->optics;
}

glm::ivec2 Fields::size(const char* key) {
    const auto values = numbers(key, 2, protocol::minViewportPixels, protocol::maxViewportPixels);
    return {int(values[0]), int(values[1])};
}

View Fields::view(const char* key) {
    const auto found = viewFromString(text(key));
    if (found) return *found;
    std::string names;
    for (const View view : allViews) {
        if (view != allViews.front()) names += view == allViews.back() ? " or " : ", ";
        names += toString(view);
    }
    refuse(key, "must be " + names);
}

int Fields::viewport() {
    return integer("viewport", 0, int(protocol::lensViewport) - 1);
}

void Fields::refuse(const std::string& key, const std::string& what) {
    throw ScriptRefusal{"\"" + key + "\" " + what};
}

void Fields::allMustBeKnown() const {
    for (const auto& [key, value] : object_.items())
        if (!asked_.count(key)) throw ScriptRefusal{"\"" + key + "\" is not a key of this action"};
}

const json& Fields::at(const char* key) const {
    const auto found = object_.find(key);
    if (found == object_.end()) throw ScriptRefusal{"\"" + std::string(key) + "\" is missing"};
    return *found;
}

template <class T>
T Fields::get(const char* key, bool (json::*is)() const noexcept, const char* what) {
    asked_.insert(key);
    const json& value = at(key);
    if (!(value.*is)()) refuse(key, std::string("must be ") + what);
    return value.get<T>();
}

}  // namespace haustra::reader
