// Optics by name: built into the program, and read from a folder of files.
#pragma once

#include "core/optics_preset.h"
#include "core/result.h"
#include "render/optics/optics.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace haustra::render {

using haustra::OpticsPreset;
using haustra::parsePreset;
using haustra::presetText;

/// Those built into the program, "mucosa" first; the build has checked that each is sound. Any
/// thread.
const std::vector<OpticsPreset>& builtInPresets();

/// What a server offers at most: the message that describes a case holds them all.
inline constexpr std::size_t mostPresets = 64;

/// What a folder holds.
struct PresetLibrary {
    std::vector<OpticsPreset> presets;
    std::vector<Error> refused;  ///< one for each file that is no preset, by its name

    const OpticsPreset* find(std::string_view name) const;
};
/// The built-in presets and those of the files *.json directly in `folder`, in the order of their
/// names; one with a built-in's name takes its place. Fails (io) where the folder cannot be read; a
/// bad file, the second of a name, or one past mostPresets is refused and the others are kept.
/// Files over 1 MiB are refused unread.
Result<PresetLibrary> readPresets(const std::filesystem::path& folder);

}  // namespace haustra::render
