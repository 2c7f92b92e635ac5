// Lines for a person to read.
#pragma once

#include <cstdio>
#include <string>

#include <glm/glm.hpp>

namespace haustra::segmentation {

/// As std::printf prints it; at most 299 bytes.
template <class... Values>
std::string text(const char* format, Values... values) {
    char line[300];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

/// "(12, -40, 118) mm", patient coordinates.
inline std::string placeText(glm::dvec3 placeMm) {
    return text("(%.0f, %.0f, %.0f) mm", placeMm.x, placeMm.y, placeMm.z);
}

}  // namespace haustra::segmentation
