// Files in the user's own folders, which nobody else reads.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <optional>
#include <string>

namespace haustra::link {

/// What the XDG base directory specification calls `variable` ("XDG_CONFIG_HOME"), else `underHome`
/// (".config") in the home folder; nothing where the environment names neither.
std::optional<std::filesystem::path> userFolder(const char* variable, const char* underHome);

/// Writes the file with mode 0600, in one step: whoever reads it sees the old text or the new. When
/// this returns without an error, the new one survives a power cut. Makes the folder, readable by
/// its owner only. Where it fails, the old file stands or the new one,
/// whole.
Result<void> writePrivateFile(const std::filesystem::path& file, const std::string& text);

}  // namespace haustra::link
