// Pictures to PNG files.
#pragma once

#include "render/view.h"

#include <filesystem>

namespace haustra::render {

/// 8-bit RGB, marked sRGB. The same image gives the same bytes. Written under a temporary name
/// beside `file` and renamed, so that a reader never sees half a picture.
Result<void> writePng(const std::filesystem::path& file, const Image& image);

}  // namespace haustra::render
