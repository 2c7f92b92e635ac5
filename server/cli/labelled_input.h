// A segmented colour volume from its files.
#pragma once

#include "render/object_order/labelled_color.h"

#include <filesystem>
#include <memory>

namespace haustra::cli {

/// Colours from a NIfTI of RGB24 or RGBA32, labels from a NIfTI of whole numbers on the same grid.
/// RGB24 has no opacity: it follows from how fast the colour changes (withColorOpacity), and what
/// has a label is a little opaque throughout.
Result<std::shared_ptr<const render::LabelledColorVolume>> readLabelledColor(
    const std::filesystem::path& color, const std::filesystem::path& labels, int threads);

}  // namespace haustra::cli
