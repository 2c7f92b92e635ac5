// Small files, read whole.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <filesystem>
#include <string>

namespace haustra {

/// All bytes of a file. Fails with what is wrong: it is not there (notFound), it is a folder or may
/// not be read (io), or it is of more than `most` bytes (badInput), of which no more are read.
Result<std::string> readTextFile(const std::filesystem::path& file,
                                 std::size_t most = std::string::npos);

}  // namespace haustra
