// What a played script measured, and its JSON form (latencies.json).
#pragma once

#include "core/bridges.h"
#include "core/colon_record.h"
#include "core/result.h"
#include "core/view.h"
#include "reader/finding_list.h"
#include "reader/flat_strip.h"
#include "reader/seen_lists.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace haustra::reader {

struct Acknowledgement {
    std::uint64_t id = 0;
    std::string clientKey;
};

/// Measurements of one action. A latency runs from queueing the message to the decoded picture
/// (or, for bookmarks, to the acknowledgement).
struct ActionReport {
    int line = 0;
    std::string name;
    double seconds = 0.0;
    std::string file;  ///< written by the action, if any
    std::vector<double> latencyMs, decodeMs;
    std::vector<std::uint32_t> renderMicroseconds, encodeMicroseconds, queueMicroseconds;
    std::string raycaster;    ///< that drew the newest of them; empty: none of the raycasters
    int coarse = 0;           ///< of them, that were smaller than their viewport
    std::uint64_t bytes = 0;  ///< tile payloads of the pictures counted here
    int positions = 0;        ///< cameras sent, of a fly action
    bool pipelined = false;
    std::vector<Acknowledgement> acknowledged;
    std::optional<std::size_t> bookmarks;
    std::optional<int> following;  ///< endoscopic pictures beside those of a fly-over
    std::optional<WallPlace> place;
    std::optional<FlatMeasure> measure;
    std::optional<double> seenShare;  ///< of the wall
    std::optional<MissedList> missed;
    std::optional<SeenReport> seenReport;
    std::optional<FindingList> findings;
};

/// What has been seen, as the server told last.
struct SeenNow {
    double share = 0.0;
    bool recorded = false;
    SeenLimits limits;
};

/// A picture that the client has had on screen, for as long as it has told.
struct LoggedPicture {
    int viewport = 0;
    std::uint32_t number = 0;  ///< the server's
    glm::ivec2 size{0};
    ViewState shown;  ///< of a flat window, in pixels of the viewport
    int viewportWidth = 0;
    std::string
        optics;  ///< the preset's name; empty: the first one's, or optics of the script's own
    std::int64_t ms = 0;
};

struct PlayReport {
    std::string clientSoftware, serverSoftware, renderer, fingerprint, caseName;
    double centerlineMm = 0.0, roundTripMs = 0.0;
    std::vector<Bridge> bridges;      ///< of the path, where no wall is seen
    std::optional<ColonTrust> trust;  ///< as the case tells it
    std::vector<ActionReport> actions;
    std::optional<SeenNow> seen;  ///< at the end, of a server that keeps a ledger
    std::optional<Error> failure;
};

/// Pretty-printed JSON. Keys name their units; percentiles as in latency.h. client/SCRIPT.md
/// describes it.
std::string toJson(const PlayReport& report);
std::string toJson(const WallPlace& place);
std::string toJson(const FlatMeasure& measure);
std::string toJson(const FindingList& findings);
std::string seenShareJson(double share, const std::optional<SeenNow>& now);
/// The ledger as the server told it, and the client's own log of what led to it.
std::string toJson(const LedgerFlags& ledger, const std::vector<LoggedPicture>& log);

}  // namespace haustra::reader
