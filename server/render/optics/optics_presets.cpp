#include "render/optics/optics_presets.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

namespace haustra::render {

// Made of presets/*.json by embed_presets.cpp.
extern const std::vector<std::pair<const char*, const char*>>& builtInPresetTexts();

const std::vector<OpticsPreset>& builtInPresets() {
    static const std::vector<OpticsPreset> presets = [] {
        std::vector<OpticsPreset> made;
        for (const auto& [file, text] : builtInPresetTexts())
            made.push_back(parsePreset(text, file).value());
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
        auto preset = readPresetFile(path);
        if (!preset) {
            library.refused.push_back(preset.error());
        } else if (std::find(read.begin(), read.end(), preset->name) != read.end()) {
            refuse(ErrorKind::badInput, "another file has a preset of this name");
        } else {
            read.push_back(preset->name);
            const auto same = std::find_if(library.presets.begin(), library.presets.end(),
                                           [&](const auto& p) { return p.name == preset->name; });
            if (same != library.presets.end())
                *same = std::move(*preset);
            else if (library.presets.size() < mostPresets)
                library.presets.push_back(std::move(*preset));
            else
                refuse(ErrorKind::badInput, "there are 64 presets already");
        }
    }
    return library;
}

}  // namespace haustra::render
