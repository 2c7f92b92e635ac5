// Pictures as PNG files.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <span>

namespace haustra::tiles {

inline constexpr std::size_t maxPngBytes = std::size_t(1) << 30;

/// Writes width·height RGB pixels (rows from the top; at most maxPngBytes of them) as an 8-bit PNG
/// file, which replaces what is there in one step. Fails with the file's name.
Result<void> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgb,
                      int width, int height);

}  // namespace haustra::tiles
