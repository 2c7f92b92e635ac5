// Lines for a person to read.
#pragma once

#include <exception>
#include <string>

#include <glm/glm.hpp>

namespace haustra {

/// What std::printf would print.
std::string printed(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// "(12, -40, 118) mm", patient coordinates.
std::string placeText(glm::dvec3 placeMm);

/// What an exception says, without the number by which nlohmann/json begins it
/// ("[json.exception.out_of_range.403] "). It may quote a file, which may be no text: bytes that
/// are no printable ASCII are told by their value, as \x89.
std::string reasonOf(const std::exception& error);

}  // namespace haustra
