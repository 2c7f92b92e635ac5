// Where the tests find real data: $HAUSTRA_DATA, else ../shared/data beside the project.
#pragma once

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

namespace haustra::tests {

inline std::filesystem::path dataFolder() {
    if (const char* set = std::getenv("HAUSTRA_DATA")) return set;
    const char* source = std::getenv("HAUSTRA_SOURCE");
    return std::filesystem::path(source ? source : ".") / ".." / "shared" / "data";
}

}  // namespace haustra::tests

/// Skips the test, saying so, where `name` is missing from the real data; else defines `variable`.
#define HAUSTRA_REAL_DATA(variable, name)                                         \
    const std::filesystem::path variable = haustra::tests::dataFolder() / (name); \
    if (!std::filesystem::exists(variable))                                       \
    GTEST_SKIP() << "no real data at " << variable << " (set HAUSTRA_DATA)"
