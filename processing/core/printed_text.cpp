#include "core/printed_text.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace haustra {

std::string printed(const char* format, ...) {
    va_list values, again;
    va_start(values, format);
    va_copy(again, values);
    std::string text(std::size_t(std::max(0, std::vsnprintf(nullptr, 0, format, values))), '\0');
    std::vsnprintf(text.data(), text.size() + 1, format, again);
    va_end(again);
    va_end(values);
    return text;
}

std::string placeText(glm::dvec3 placeMm) {
    return printed("(%.0f, %.0f, %.0f) mm", placeMm.x, placeMm.y, placeMm.z);
}

std::string reasonOf(const std::exception& error) {
    const std::string what = error.what();
    const std::size_t end = what.starts_with("[json.") ? what.find("] ") : std::string::npos;
    std::string reason;
    for (const char c : end == std::string::npos ? what : what.substr(end + 2))
        reason += c >= ' ' && c <= '~'
                      ? std::string(1, c)
                      : printed("\\x%02x", unsigned(static_cast<unsigned char>(c)));
    return reason;
}

}  // namespace haustra
