// The profiles of this folder, built into the program so that it needs no files beside it.
#pragma once

#include <map>
#include <string_view>

namespace haustra::organs {

/// The text of each profile by its organ's name ("colon"). Any thread.
const std::map<std::string_view, std::string_view>& builtInProfiles();

}  // namespace haustra::organs
