// Optics by name, as a file has them.
#pragma once

#include "core/optics.h"
#include "core/result.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace haustra {

/// A named way to look at a scan. In a file, JSON (server/render/optics/presets has the built-in
/// ones):
///   {"name": "mucosa",            letters, digits, '-' and '_', at most 64
///    "description": "…",          for a person, at most 1000 bytes; may be missing
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
    bool operator==(const OpticsPreset&) const = default;
};
/// Names of the electronic biopsy's (§6.2.4): with fixed colours, which every server has, and with
/// those derived from one scan (§7.2.5), which its case may have.
inline constexpr char biopsyPreset[] = "biopsy", scanBiopsyPreset[] = "biopsy-scan";

bool isPresetName(std::string_view text);

/// "emission-absorption", "maximum-intensity", "first-hit".
const char* toString(Composition composition);
std::optional<Composition> compositionFromString(std::string_view text);

/// Fails (badInput) where the text is no such JSON or its optics do not pass checkOptics; `place`
/// names the text in that message.
Result<OpticsPreset> parsePreset(std::string_view json, const std::string& place);
/// The text of a file that parsePreset reads back as it was.
std::string presetText(const OpticsPreset& preset);

/// The preset of a file of at most 1 MiB. Fails (io) where it cannot be read, else as parsePreset.
Result<OpticsPreset> readPresetFile(const std::filesystem::path& file);
/// Replaces `file` in one step. Fails (io).
Result<void> writePresetFile(const std::filesystem::path& file, const OpticsPreset& preset);

}  // namespace haustra
