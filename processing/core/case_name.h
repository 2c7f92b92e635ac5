// What a case may be called.
#pragma once

#include <string_view>

namespace haustra {

/// True where `name` can name a case: 1…64 of letters, digits, '.', '_', '-', not starting with
/// '.'. It names a folder, and is told to clients.
inline bool isCaseName(std::string_view name) {
    constexpr std::string_view allowed =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
    return !name.empty() && name.size() <= 64 && name[0] != '.' &&
           name.find_first_not_of(allowed) == std::string_view::npos;
}

}  // namespace haustra
