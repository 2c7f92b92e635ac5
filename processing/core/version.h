// Which Haustra this is.
#pragma once

namespace haustra {

/// "major.minor.patch", as the project's CMakeLists.txt has it: the one place that says it.
extern const char* const softwareVersion;

}  // namespace haustra
