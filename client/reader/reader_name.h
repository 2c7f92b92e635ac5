// How a reader's clients name the reader to servers, which keep for each what has been seen.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <string>

namespace haustra::reader {

/// 1 to protocol::maxReaderBytes of visible ASCII; else (badInput).
Result<std::string> checkReaderName(const std::string& name);

/// The name that the file holds; where there is no file, it is made, readable by the user alone,
/// with 128 random bits: whoever does not know them cannot read or change what is kept under them.
/// Fails (io) where it cannot be written or read, (badInput) where it holds no name.
Result<std::string> readerNameIn(const std::filesystem::path& file);

/// $XDG_DATA_HOME/haustra/reader, else ~/.local/share/haustra/reader. Fails where neither variable
/// is set.
Result<std::filesystem::path> defaultReaderFile();

}  // namespace haustra::reader
