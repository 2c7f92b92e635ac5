// What one process does at a time.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <memory>

namespace haustra::store {

enum class WhereLocked { wait, refuse };

/// flock(2) on a file, which is made where it is not there; held until the last copy is gone, or
/// the process ends, however it ends. Of one process, too, only one at a time has it. Fails (io)
/// where the file cannot be opened or locked and, to `refuse`, (wrongState) where another holds it.
Result<std::shared_ptr<const void>> lockFile(const std::filesystem::path& file, WhereLocked then);

}  // namespace haustra::store
