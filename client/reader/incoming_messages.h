// What the server said, in the client's own types. It is checked here: beyond this file a case has
// a sound grid, a centerline with finite, ordered samples, and a strip whose rows are finite and in
// order.
#pragma once

#include "core/scan_values.h"
#include "protocol/haustra.pb.h"
#include "reader/case_info.h"

namespace haustra::reader {

/// Fails, naming the field, where the server's description of the case is not sound.
Result<CaseInfo> caseInfoFrom(const protocol::CaseOpened& message);
/// An entry for each name, in the names' order.
std::vector<CaseEntry> casesFrom(const protocol::CaseList& message);
Bookmark bookmarkFrom(const protocol::Bookmark& message);
/// Fail where a number is not finite.
Result<WallPlace> placeFrom(const protocol::WallPlace& message);
Result<FlatMeasure> measureFrom(const protocol::FlatMeasure& message);
Result<ScanStatistics> statisticsFrom(const protocol::ScanStatistics& message);

}  // namespace haustra::reader
