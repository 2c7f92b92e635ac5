// What clients say, checked against PROTOCOL.md §4, and what the server answers: all but the views
// themselves, which protocol/view_message.h has.
#pragma once

#include "core/result.h"
#include "protocol/haustra.pb.h"
#include "protocol/limits.h"
#include "records/bookmarks.h"
#include "render/optics/optics_presets.h"
#include "session/case_list.h"
#include "session/case_questions.h"
#include "session/marked_bookmark.h"
#include "session/open_case.h"
#include "session/seen_ledger.h"

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace haustra::session {

// Each fails (badInput), naming the field and no patient, on a value out of its bounds.

/// One of the presets by name, or optics of the client's own; not both.
Result<Optics> opticsFrom(const protocol::SetTransferFunction& message,
                          const render::PresetLibrary& presets);

/// A camera's place with finite arc; the note is at most protocol::maxNoteBytes without control
/// characters but line feed and tab; the key is 1 to protocol::maxClientKeyBytes of visible ASCII.
Result<records::NewBookmark> bookmarkFrom(const protocol::AddBookmark& message,
                                          const std::string& caseName, const std::string& scan);

/// 1 to protocol::maxReaderBytes of visible ASCII.
Result<std::string> readerFrom(const std::string& name);
/// What is missing is usual.
Result<SeenLimits> seenLimitsFrom(const protocol::SetSeenLimits& message);
/// 0 is leastMissedMm2; else protocol::leastListedMm2 to mostListedMm2.
Result<double> leastMm2From(double message);

/// Of a case that has a wall.
Result<CaseQuestion> questionFrom(const protocol::LocateFlat& message, const OpenCase& of);
Result<CaseQuestion> questionFrom(const protocol::LocatePoint& message, const OpenCase& of);
Result<CaseQuestion> questionFrom(const protocol::MeasureFlat& message, const OpenCase& of);
/// Of any.
Result<CaseQuestion> questionFrom(const protocol::MeasureScan& message, const OpenCase& of);
Result<CaseQuestion> questionFrom(const protocol::PickWall& message, const OpenCase& of);
template <class Question>
bool asksAboutStrip(const Question&) {
    return !std::is_same_v<Question, protocol::MeasureScan> &&
           !std::is_same_v<Question, protocol::PickWall>;
}

/// How much of a session's share of unanswered requests a question takes.
inline int weightOf(const protocol::LocateFlat&) {
    return 1;
}
inline int weightOf(const protocol::LocatePoint&) {
    return 1;
}
inline int weightOf(const protocol::MeasureFlat&) {
    return protocol::measurementWeight;
}
inline int weightOf(const protocol::MeasureScan&) {
    return protocol::measurementWeight;
}
inline int weightOf(const protocol::PickWall&) {
    return protocol::measurementWeight;
}

/// The message as a frame. One over the protocol's bound becomes an INTERNAL error of its request.
std::vector<std::uint8_t> frameOf(const protocol::ServerMessage& message);

protocol::ServerMessage errorMessage(protocol::ErrorReport::Code code, const std::string& message,
                                     bool fatal, std::uint64_t request = 0);

protocol::ServerMessage caseOpenedMessage(const OpenCase& opened,
                                          const render::PresetLibrary& presets);

/// Without the entries of cases that do not fit into the message any more.
protocol::ServerMessage caseListMessage(const std::vector<CaseSummary>& cases,
                                        const OpenCounts& readers, std::uint64_t request);

void fill(protocol::Bookmark& message, const MarkedBookmark& bookmark);
protocol::ServerMessage bookmarkAddedMessage(const MarkedBookmark& bookmark, std::uint64_t request);

/// Those that a reader who has made this choice is shown, along the colon; where none may be shown,
/// why. Voxels of findings come before those of candidates, as far as the protocol has room. Some
/// microseconds each.
protocol::ServerMessage findingListMessage(const OpenCase& of, const DetectionChoice& choice,
                                           std::uint64_t request);

void fill(protocol::SeenLimits& message, const SeenLimits& limits);
protocol::ServerMessage missedListMessage(const Missed& missed, double leastMm2,
                                          std::uint64_t request);
protocol::ServerMessage ledgerMessage(const SeenFlags& flags, const records::LedgerKey& key,
                                      bool recorded, std::uint64_t request);
/// `own`: of the session that asks; other readers are told by marks of their names.
protocol::ServerMessage seenReportMessage(const std::vector<ReaderSeen>& readers,
                                          const records::LedgerKey& own, double leastMm2,
                                          std::uint64_t request);

protocol::ServerMessage messageOf(const CaseAnswer& answer, std::uint64_t request);

}  // namespace haustra::session
