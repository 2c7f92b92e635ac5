// Optics by name: built into the program, and read from a folder of files.
#pragma once

#include "core/result.h"
#include "render/optics/optics.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace haustra::render {

/// A named way to look at a scan. In a file, JSON (server/render/optics/presets has the built-in
/// ones):
///   {"name": "mucosa",            letters, digits, '-' and '_', at most 64
///    "description": "…",          for a person; may be missing
///    "composition": "emission-absorption" | "maximum-intensity" | "first-hit",
///    "preIntegrated": false, "shading": true,
///    "light": {"halfDepthMm": 65, "ambient": 0.05, "diffuse": 0.95, "specular": 0.08,
///              "shininess": 20},
///    "points": [{"hu": -750, "color": [0.86, 0.49, 0.42], "opacity": 0}, …],
///    "rows": [{"gradientHuPerMm": 200, "points": […]}, …]}
/// What is missing, but for name and points, has the default of Optics. Unknown keys are refused: a
/// typing error must not go unnoticed.
struct OpticsPreset {
    std::string name, description;
    Optics optics;
};

/// Fails (badInput) where the text is no such JSON or its optics do not pass checkOptics; `place`
/// names the text in that message.
Result<OpticsPreset> parsePreset(std::string_view json, const std::string& place);
/// The text of a file that parsePreset reads back as it was.
std::string presetText(const OpticsPreset& preset);

/// Those built into the program, "mucosa" first. Any thread.
const std::vector<OpticsPreset>& builtInPresets();

/// What a folder holds.
struct PresetLibrary {
    std::vector<OpticsPreset> presets;
    std::vector<Error> refused;  ///< one for each file that is no preset, by its name

    const OpticsPreset* find(std::string_view name) const;
};
/// The built-in presets and those of the files *.json directly in `folder`, in the order of their
/// names; one with a built-in's name takes its place. Fails (io) where the folder cannot be read; a
/// bad file, or the second of a name, is refused and the others are kept. Files over 1 MiB are
/// refused unread.
Result<PresetLibrary> readPresets(const std::filesystem::path& folder);

}  // namespace haustra::render
