#include "render/optics/optics_presets.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

namespace haustra::render {

// Made of presets/*.json by embed_presets.cmake.
extern const std::vector<std::pair<const char*, const char*>>& builtInPresetTexts();

namespace {

using Json = nlohmann::json;

constexpr std::array<std::pair<const char*, Composition>, 3> compositions{
    {{"emission-absorption", Composition::emissionAbsorption},
     {"maximum-intensity", Composition::maximumIntensity},
     {"first-hit", Composition::firstHit}}};

/// Thrown and caught in this file: what a preset's text has wrong.
struct BadPreset {
    std::string what;
};

/// Refuses what is no object, and keys that are not among `known`.
void expectKeys(const Json& json, const char* what, std::initializer_list<const char*> known) {
    if (!json.is_object()) throw BadPreset{std::string(what) + " is no object"};
    for (const auto& [key, value] : json.items())
        if (std::none_of(known.begin(), known.end(), [&](const char* k) { return key == k; }))
            throw BadPreset{std::string(what) + " has an unknown key \"" + key + "\""};
}

double numberIn(const Json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end() || !found->is_number())
        throw BadPreset{std::string("\"") + key + "\" is missing or no number"};
    return found->get<double>();
}

bool flagIn(const Json& json, const char* key, bool otherwise) {
    const auto found = json.find(key);
    if (found == json.end()) return otherwise;
    if (!found->is_boolean())
        throw BadPreset{std::string("\"") + key + "\" is neither true nor false"};
    return found->get<bool>();
}

std::string textIn(const Json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end()) return {};
    if (!found->is_string()) throw BadPreset{std::string("\"") + key + "\" is no text"};
    return found->get<std::string>();
}

std::vector<TransferFunctionPoint> pointsIn(const Json& json) {
    const auto found = json.find("points");
    if (found == json.end() || !found->is_array())
        throw BadPreset{"\"points\" is missing or no array"};
    std::vector<TransferFunctionPoint> points;
    for (const Json& point : *found) {
        expectKeys(point, "a point", {"hu", "color", "opacity"});
        const auto color = point.find("color");
        if (color == point.end() || !color->is_array() || color->size() != 3 ||
            !std::all_of(color->begin(), color->end(), [](const Json& c) { return c.is_number(); }))
            throw BadPreset{"\"color\" of a point is not three numbers"};
        points.push_back(
            {numberIn(point, "hu"),
             {(*color)[0].get<double>(), (*color)[1].get<double>(), (*color)[2].get<double>()},
             numberIn(point, "opacity")});
    }
    return points;
}

Composition compositionIn(const Json& json) {
    const std::string text = textIn(json, "composition");
    if (text.empty()) return Optics{}.composition;
    for (const auto& [name, composition] : compositions)
        if (text == name) return composition;
    throw BadPreset{"\"composition\" is none of emission-absorption, maximum-intensity, first-hit"};
}

OpticsPreset presetIn(const Json& json) {
    expectKeys(json, "the preset",
               {"name", "description", "composition", "preIntegrated", "shading", "light", "points",
                "rows"});
    OpticsPreset preset{textIn(json, "name"), textIn(json, "description"), {}};
    const auto isNameCharacter = [](unsigned char c) {
        return (c < 128 && std::isalnum(c)) || c == '-' || c == '_';
    };
    if (preset.name.empty() || preset.name.size() > 64 ||
        !std::all_of(preset.name.begin(), preset.name.end(), isNameCharacter))
        throw BadPreset{"\"name\" is not 1 to 64 letters, digits, '-' and '_'"};
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
        for (const Json& row : *rows) {
            expectKeys(row, "a row", {"gradientHuPerMm", "points"});
            optics.transferFunction.rows.push_back(
                {numberIn(row, "gradientHuPerMm"), pointsIn(row)});
        }
    }
    return preset;
}

Json pointsJson(const std::vector<TransferFunctionPoint>& points) {
    Json json = Json::array();
    for (const TransferFunctionPoint& point : points)
        json.push_back({{"hu", point.hu},
                        {"color", {point.color.r, point.color.g, point.color.b}},
                        {"opacity", point.opacity}});
    return json;
}

}  // namespace

Result<OpticsPreset> parsePreset(std::string_view json, const std::string& place) {
    try {
        OpticsPreset preset = presetIn(Json::parse(json));
        if (auto sound = checkOptics(preset.optics); !sound)
            return fail(ErrorKind::badInput, describe(sound.error()), place);
        return preset;
    } catch (const BadPreset& bad) {
        return fail(ErrorKind::badInput, bad.what, place);
    } catch (const Json::exception&) {
        return fail(ErrorKind::badInput, "this is no sound JSON", place);
    }
}

std::string presetText(const OpticsPreset& preset) {
    const Optics& optics = preset.optics;
    nlohmann::ordered_json json{{"name", preset.name}, {"description", preset.description}};
    for (const auto& [name, composition] : compositions)
        if (optics.composition == composition) json["composition"] = name;
    json["preIntegrated"] = optics.preIntegrated;
    json["shading"] = optics.shading;
    json["light"] = {{"halfDepthMm", optics.light.halfDepthMm},
                     {"ambient", optics.light.ambient},
                     {"diffuse", optics.light.diffuse},
                     {"specular", optics.light.specular},
                     {"shininess", optics.light.shininess}};
    json["points"] = pointsJson(optics.transferFunction.points);
    if (!optics.transferFunction.rows.empty()) {
        Json rows = Json::array();
        for (const GradientRow& row : optics.transferFunction.rows)
            rows.push_back(
                {{"gradientHuPerMm", row.gradientHuPerMm}, {"points", pointsJson(row.points)}});
        json["rows"] = rows;
    }
    // What a client names it may be no UTF-8.
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

const std::vector<OpticsPreset>& builtInPresets() {
    static const std::vector<OpticsPreset> presets = [] {
        std::vector<OpticsPreset> made;
        for (const auto& [file, text] : builtInPresetTexts())
            if (auto preset = parsePreset(text, file)) made.push_back(std::move(*preset));
        const auto isDefault = [](const OpticsPreset& p) { return p.name == "mucosa"; };
        std::stable_partition(made.begin(), made.end(), isDefault);
        return made;
    }();
    return presets;
}

const std::vector<std::string>& opticsPresets() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> made;
        for (const OpticsPreset& preset : builtInPresets())
            made.push_back(preset.name);
        return made;
    }();
    return names;
}

Result<Optics> opticsPreset(const std::string& name) {
    std::string names;
    for (const OpticsPreset& preset : builtInPresets()) {
        if (preset.name == name) return preset.optics;
        names += (names.empty() ? "" : ", ") + preset.name;
    }
    return fail(ErrorKind::badInput, "no transfer function named '" + name + "' (" + names + ")");
}

const OpticsPreset* PresetLibrary::find(std::string_view name) const {
    const auto found = std::find_if(presets.begin(), presets.end(),
                                    [&](const OpticsPreset& p) { return p.name == name; });
    return found == presets.end() ? nullptr : &*found;
}

Result<PresetLibrary> readPresets(const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    constexpr std::uintmax_t longestFile = 1 << 20;
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (at->path().extension() == ".json") files.push_back(at->path());
    if (error) return fail(ErrorKind::io, "cannot read the folder of presets", folder.string());
    std::sort(files.begin(), files.end());

    PresetLibrary library{builtInPresets(), {}};
    std::vector<std::string> read;
    for (const fs::path& path : files) {
        const auto refuse = [&](ErrorKind kind, const char* what) {
            library.refused.push_back({kind, what, path.filename().string()});
        };
        const std::uintmax_t bytes = fs::file_size(path, error);
        if (error || bytes > longestFile) {
            refuse(ErrorKind::io, "cannot be read, or is over 1 MiB");
            continue;
        }
        std::ifstream file(path, std::ios::binary);
        const std::string text(std::istreambuf_iterator<char>(file), {});
        if (!file) {
            refuse(ErrorKind::io, "cannot be read");
            continue;
        }
        auto preset = parsePreset(text, path.filename().string());
        if (!preset) {
            library.refused.push_back(preset.error());
        } else if (std::find(read.begin(), read.end(), preset->name) != read.end()) {
            refuse(ErrorKind::badInput, "another file has a preset of this name");
        } else {
            read.push_back(preset->name);
            const auto same = std::find_if(library.presets.begin(), library.presets.end(),
                                           [&](const auto& p) { return p.name == preset->name; });
            if (same == library.presets.end())
                library.presets.push_back(std::move(*preset));
            else
                *same = std::move(*preset);
        }
    }
    return library;
}

}  // namespace haustra::render
