// Small files, read whole.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <string>

namespace haustra {

/// All bytes of a file. Fails with what is wrong: it is not there (notFound), or it is a folder or
/// may not be read (io).
Result<std::string> readTextFile(const std::filesystem::path& file);

}  // namespace haustra
