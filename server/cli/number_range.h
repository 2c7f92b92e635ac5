// A range of numbers for an option.
#pragma once

#include "cli/arguments.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::cli {

/// Numbers from `low` to `high`. CLI::Range lets NaN through, as that is neither below nor above.
inline CLI::Validator numberRange(double low, double high) {
    const std::string range = fmt::format("in [{:.10g} - {:.10g}]", low, high);
    return CLI::Validator(
        [=](std::string& text) {
            const auto number = parseNumbers(text, ',', 1);
            return number && (*number)[0] >= low && (*number)[0] <= high
                       ? std::string()
                       : fmt::format("\"{}\" is no number {}", text, range);
        },
        "FLOAT " + range);
}

}  // namespace haustra::cli
