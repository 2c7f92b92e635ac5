// Names that nobody else chooses.
#pragma once

#include <string>

namespace haustra::reader {

/// 128 random bits, as 32 hexadecimal digits.
std::string randomKey();

}  // namespace haustra::reader
