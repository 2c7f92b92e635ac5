// Pictures as PNG files.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <span>

namespace haustra::tiles {

/// Writes width·height RGB pixels (rows from the top) as an 8-bit PNG file, replacing what is
/// there. Fails with the file's name.
Result<void> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgb,
                      int width, int height);

}  // namespace haustra::tiles
