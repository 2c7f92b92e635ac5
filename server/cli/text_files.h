// Centerlines and reports as files that other programs read.
#pragma once

#include "core/centerline.h"
#include "core/result.h"

#include <filesystem>
#include <string>

namespace haustra::cli {

/// Fails where `file` is a folder, or its folder is missing or cannot be written: known before the
/// work that makes the content.
Result<void> checkOutputFile(const std::filesystem::path& file);

/// Fails where `folder` is no folder in which files can be made, nor one that can be made: known
/// before the work whose files it takes.
Result<void> checkOutputFolder(const std::filesystem::path& folder);

/// A line of names, `x_mm,y_mm,z_mm,arc_mm,radius_mm,gap`, then a line for each sample from the
/// rectum to the cecum; gap is 0 or 1.
std::string centerlineCsv(const Centerline& centerline);

/// Reads what centerlineCsv writes; the gap column may be missing.
Result<Centerline> readCenterlineCsv(const std::filesystem::path& file);

}  // namespace haustra::cli
