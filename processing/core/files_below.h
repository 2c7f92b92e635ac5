// The files of a folder.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace haustra {

/// Regular files at or below `path`, sorted by name; a file itself. Links are followed, and each
/// folder is entered once, whatever links lead to it. Fails, naming it, where the path does not
/// exist, is neither file nor folder, cannot be listed, or holds more than `most` files.
Result<std::vector<std::filesystem::path>> filesBelow(const std::filesystem::path& path,
                                                      std::size_t most = 100'000);

}  // namespace haustra
