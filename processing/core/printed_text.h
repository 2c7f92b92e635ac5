// Lines for a person to read.
#pragma once

#include <string>

#include <glm/glm.hpp>

namespace haustra {

/// What std::printf would print.
std::string printed(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// "(12, -40, 118) mm", patient coordinates.
std::string placeText(glm::dvec3 placeMm);

}  // namespace haustra
