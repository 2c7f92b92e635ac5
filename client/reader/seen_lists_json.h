// What has been seen, as the files that a person keeps have it (client/SCRIPT.md).
#pragma once

#include "reader/seen_lists.h"

#include <string>

namespace haustra::reader {

/// One JSON object, pretty-printed.
std::string toJson(const MissedList& missed);
/// With the case that it was asked about, where that is not empty.
std::string toJson(const SeenReport& report, const std::string& caseName);

}  // namespace haustra::reader
