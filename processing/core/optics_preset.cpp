#include "core/optics_preset.h"

#include "core/durable_file.h"
#include "core/text_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <initializer_list>
#include <utility>

#include <nlohmann/json.hpp>

namespace haustra {
namespace {

using PresetJson = nlohmann::json;

constexpr std::size_t mostDescriptionBytes = 1000;

constexpr std::array<std::pair<const char*, Composition>, 3> compositions{
    {{"emission-absorption", Composition::emissionAbsorption},
     {"maximum-intensity", Composition::maximumIntensity},
     {"first-hit", Composition::firstHit}}};

/// Thrown and caught in this file: what a preset's text has wrong.
struct BadPreset {
    std::string what;
};

/// Refuses what is no object, and keys that are not among `known`.
void expectKeys(const PresetJson& json, const char* what,
                std::initializer_list<const char*> known) {
    if (!json.is_object()) throw BadPreset{std::string(what) + " is no object"};
    for (const auto& item : json.items()) {
        const std::string& key = item.key();
        if (std::none_of(known.begin(), known.end(), [&](const char* k) { return key == k; }))
            throw BadPreset{std::string(what) + " has an unknown key \"" + key + "\""};
    }
}

double numberIn(const PresetJson& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end() || !found->is_number())
        throw BadPreset{std::string("\"") + key + "\" is missing or no number"};
    return found->get<double>();
}

bool flagIn(const PresetJson& json, const char* key, bool otherwise) {
    const auto found = json.find(key);
    if (found == json.end()) return otherwise;
    if (!found->is_boolean())
        throw BadPreset{std::string("\"") + key + "\" is neither true nor false"};
    return found->get<bool>();
}

std::string textIn(const PresetJson& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end()) return {};
    if (!found->is_string()) throw BadPreset{std::string("\"") + key + "\" is no text"};
    return found->get<std::string>();
}

std::vector<TransferFunctionPoint> pointsIn(const PresetJson& json) {
    const auto found = json.find("points");
    if (found == json.end() || !found->is_array())
        throw BadPreset{"\"points\" is missing or no array"};
    std::vector<TransferFunctionPoint> points;
    for (const PresetJson& point : *found) {
        expectKeys(point, "a point", {"hu", "color", "opacity"});
        const auto color = point.find("color");
        if (color == point.end() || !color->is_array() || color->size() != 3 ||
            !std::all_of(color->begin(), color->end(),
                         [](const PresetJson& c) { return c.is_number(); }))
            throw BadPreset{"\"color\" of a point is not three numbers"};
        points.push_back(
            {numberIn(point, "hu"),
             {(*color)[0].get<double>(), (*color)[1].get<double>(), (*color)[2].get<double>()},
             numberIn(point, "opacity")});
    }
    return points;
}

Composition compositionIn(const PresetJson& json) {
    const std::string text = textIn(json, "composition");
    if (text.empty()) return Optics{}.composition;
    if (const auto composition = compositionFromString(text)) return *composition;
    throw BadPreset{"\"composition\" is none of emission-absorption, maximum-intensity, first-hit"};
}

OpticsPreset presetIn(const PresetJson& json) {
    expectKeys(json, "the preset",
               {"name", "description", "composition", "preIntegrated", "shading", "light", "points",
                "rows"});
    OpticsPreset preset{textIn(json, "name"), textIn(json, "description"), {}};
    if (!isPresetName(preset.name))
        throw BadPreset{"\"name\" is not 1 to 64 letters, digits, '-' and '_'"};
    if (preset.description.size() > mostDescriptionBytes)
        throw BadPreset{"\"description\" has more than 1000 bytes"};
    Optics& optics = preset.optics;
    optics.composition = compositionIn(json);
    optics.preIntegrated = flagIn(json, "preIntegrated", optics.preIntegrated);
    optics.shading = flagIn(json, "shading", optics.shading);
    if (const auto light = json.find("light"); light != json.end()) {
        expectKeys(*light, "the light",
                   {"halfDepthMm", "ambient", "diffuse", "specular", "shininess"});
        optics.light = {numberIn(*light, "halfDepthMm"), numberIn(*light, "ambient"),
                        numberIn(*light, "diffuse"), numberIn(*light, "specular"),
                        numberIn(*light, "shininess")};
    }
    optics.transferFunction.points = pointsIn(json);
    if (const auto rows = json.find("rows"); rows != json.end()) {
        if (!rows->is_array()) throw BadPreset{"\"rows\" is no array"};
        for (const PresetJson& row : *rows) {
            expectKeys(row, "a row", {"gradientHuPerMm", "points"});
            optics.transferFunction.rows.push_back(
                {numberIn(row, "gradientHuPerMm"), pointsIn(row)});
        }
    }
    return preset;
}

PresetJson pointsJson(const std::vector<TransferFunctionPoint>& points) {
    PresetJson json = PresetJson::array();
    for (const TransferFunctionPoint& point : points)
        json.push_back({{"hu", point.hu},
                        {"color", {point.color.r, point.color.g, point.color.b}},
                        {"opacity", point.opacity}});
    return json;
}

}  // namespace

bool isPresetName(std::string_view text) {
    const auto isNameCharacter = [](unsigned char c) {
        return (c < 128 && std::isalnum(c)) || c == '-' || c == '_';
    };
    return !text.empty() && text.size() <= 64 &&
           std::all_of(text.begin(), text.end(), isNameCharacter);
}

const char* toString(Composition composition) {
    for (const auto& [name, which] : compositions)
        if (which == composition) return name;
    return "";
}

std::optional<Composition> compositionFromString(std::string_view text) {
    for (const auto& [name, composition] : compositions)
        if (text == name) return composition;
    return std::nullopt;
}

Result<OpticsPreset> parsePreset(std::string_view json, const std::string& place) {
    try {
        OpticsPreset preset = presetIn(PresetJson::parse(json));
        if (auto sound = checkOptics(preset.optics); !sound)
            return fail(ErrorKind::badInput, describe(sound.error()), place);
        return preset;
    } catch (const BadPreset& bad) {
        return fail(ErrorKind::badInput, bad.what, place);
    } catch (const PresetJson::exception&) {
        return fail(ErrorKind::badInput, "this is no sound JSON", place);
    }
}

std::string presetText(const OpticsPreset& preset) {
    const Optics& optics = preset.optics;
    nlohmann::ordered_json json{{"name", preset.name}, {"description", preset.description}};
    json["composition"] = toString(optics.composition);
    json["preIntegrated"] = optics.preIntegrated;
    json["shading"] = optics.shading;
    json["light"] = {{"halfDepthMm", optics.light.halfDepthMm},
                     {"ambient", optics.light.ambient},
                     {"diffuse", optics.light.diffuse},
                     {"specular", optics.light.specular},
                     {"shininess", optics.light.shininess}};
    json["points"] = pointsJson(optics.transferFunction.points);
    if (!optics.transferFunction.rows.empty()) {
        PresetJson rows = PresetJson::array();
        for (const GradientRow& row : optics.transferFunction.rows)
            rows.push_back(
                {{"gradientHuPerMm", row.gradientHuPerMm}, {"points", pointsJson(row.points)}});
        json["rows"] = rows;
    }
    // What a client names it may be no UTF-8.
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<OpticsPreset> readPresetFile(const std::filesystem::path& file) {
    constexpr std::size_t longestFile = 1 << 20;
    const std::string place = file.filename().string();
    // A pipe would be waited for, without end where nobody writes to it.
    std::error_code ignored;
    if (std::filesystem::is_other(file, ignored))
        return fail(ErrorKind::io, "this is a pipe or a device, not a file to read", place);
    auto text = readTextFile(file, longestFile);
    if (!text) text.error().place = place;  // not where the presets of a server lie
    return parsePreset(TRY(std::move(text)), place);
}

Result<void> writePresetFile(const std::filesystem::path& file, const OpticsPreset& preset) {
    return writeDurably(file, presetText(preset));
}

}  // namespace haustra
