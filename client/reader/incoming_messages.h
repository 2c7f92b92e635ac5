// What the server said, in the client's own types. It is checked here: beyond this file a case has
// a sound grid, a centerline with finite, ordered samples, and a strip whose rows are finite and in
// order; every place lies within the protocol's bounds, and every text can be shown.
#pragma once

#include "core/scan_values.h"
#include "protocol/haustra.pb.h"
#include "protocol/limits.h"
#include "reader/case_info.h"
#include "reader/finding_list.h"
#include "reader/seen_lists.h"

namespace haustra::reader {

/// Fails, naming the field, where the server's description of the case is not sound.
Result<CaseInfo> caseInfoFrom(const protocol::CaseOpened& message);
/// An entry for each name, in the names' order, of the first protocol::maxListedCases. Fails where
/// one is no case's name or they are not sorted.
Result<std::vector<CaseEntry>> casesFrom(const protocol::CaseList& message);
/// Its directions are unit and orthogonal. Fails where it could not have been added.
Result<Bookmark> bookmarkFrom(const protocol::Bookmark& message);
/// The most of them that a scan has.
inline constexpr std::size_t maxScanBookmarks =
    protocol::maxScanBookmarkBytes / protocol::bookmarkOverheadBytes;
/// Fail where a number is not finite, or no place or value of a scan.
Result<WallPlace> placeFrom(const protocol::WallPlace& message);
Result<FlatMeasure> measureFrom(const protocol::FlatMeasure& message);
Result<ScanStatistics> statisticsFrom(const protocol::ScanStatistics& message);
/// Fails where a finding lies nowhere, its voxels are none of the case's grid, they are not in the
/// order of their arcs, two have the same number, or there are any that should be hidden.
Result<FindingList> findingsFrom(const protocol::FindingList& message, const Grid& grid);
/// Fail where a share, an area or a limit is out of its bounds, a place is none, a list is longer
/// than a server's, or flags are not as many as triangles.
Result<SeenLimits> seenLimitsFrom(const protocol::SeenLimits& message);
Result<MissedList> missedFrom(const protocol::MissedList& message);
Result<LedgerFlags> ledgerFrom(const protocol::Ledger& message);
Result<SeenReport> seenReportFrom(const protocol::SeenReport& message);

}  // namespace haustra::reader
