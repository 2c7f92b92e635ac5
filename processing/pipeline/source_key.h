// The key of what comes from outside the store.
#pragma once

#include "core/result.h"
#include "store/case_store.h"

#include <filesystem>

namespace haustra::pipeline {

/// Hashes the content of a file, or of all files in a folder at any depth. Names and places of
/// the files do not count, as they do not count for a DICOM series. Reads everything once, at the
/// speed of `threads` threads (≤ 0: all cores).
Result<store::ProductKey> sourceKey(const std::filesystem::path& source, int threads);

}  // namespace haustra::pipeline
