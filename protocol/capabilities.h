// What one side tells the other that it knows beyond what every version 1 does (PROTOCOL.md §4,
// Hello and Welcome): each name once.
#pragma once

namespace haustra::protocol::capability {

// ---- both: how pictures may come
inline constexpr char jpeg[] = "jpeg", lossless[] = "lossless", coarse[] = "coarse";
// ---- a client: what it may be told unasked; a server: what it tells to such a client
inline constexpr char bookmarkPush[] = "bookmark-push";  ///< others' bookmarks, as they are added
// ---- both: TellShown, and what is asked about what has been seen
inline constexpr char ledger[] = "ledger";
// ---- a server: what it may be asked, and what it tells besides
inline constexpr char slabs[] = "slabs";               ///< slices with a slab, moved by a pan
inline constexpr char caseEntries[] = "case-entries";  ///< CaseList says more than names
inline constexpr char marks[] = "marks";               ///< Bookmark.mark
inline constexpr char scanValues[] = "scan-values";    ///< MeasureScan
inline constexpr char pick[] = "pick";                 ///< PickWall
inline constexpr char lens[] = "lens";                 ///< viewport 8, SetViewport.lens
inline constexpr char findings[] = "findings";         ///< SetDetection, ListFindings

}  // namespace haustra::protocol::capability
