// The reader's session with a server: what is asked for, what has come, what is still owed.
#pragma once

#include "core/detection_choice.h"
#include "core/scan_values.h"
#include "link/connection.h"
#include "reader/bookmark_journal.h"
#include "reader/case_info.h"
#include "reader/finding_list.h"
#include "reader/latency.h"
#include "reader/screen_time.h"
#include "reader/seen_lists.h"
#include "tiles/picture.h"

#include <array>
#include <deque>
#include <map>
#include <unordered_map>
#include <utility>
#include <variant>

namespace haustra::reader {

using link::Clock;

enum class Phase {
    connecting,  ///< no link yet, or the case is being opened
    choosing,    ///< linked; no case was named: cases() tells what there is
    open,        ///< pictures flow
    lost,        ///< the link is down; it is tried again
    failed,      ///< for good: failure() tells why
};

/// What became of a bookmark that was owed.
struct BookmarkOutcome {
    Bookmark bookmark;  ///< as it was sent
    bool saved;         ///< the server has it; else it refused it: see refusedBookmarks()
};

struct RefusedBookmark {
    Bookmark bookmark;
    std::string reason;  ///< the server's
};

using haustra::ScanRegion;
using haustra::ScanStatistics;

/// Owns the connection; belongs to one thread. The session remembers what each viewport is to
/// show, so that after a lost link everything is asked for again, and bookmarks that the server
/// has not acknowledged are sent again under the same key. With a journal they outlive the session:
/// each is on the disk before it is sent, and until the server has acknowledged it or the reader
/// has dismissed it; when the case is open again over this server, on the same scan, it is taken
/// up.
class Session {
public:
    /// Opens `caseName` once linked; where it is empty, asks for the list of cases.
    Session(link::ConnectionOptions options, std::string caseName,
            std::optional<BookmarkJournal> journal = {});

    /// Takes in what has arrived, waiting at most `patience` for the first event.
    void poll(std::chrono::milliseconds patience);

    Phase phase() const { return phase_; }
    const Error& failure() const { return failure_; }  ///< of phases lost and failed
    const link::LinkUp& server() const { return server_; }
    /// Of the server that was met last: whether it says that it knows this
    /// (protocol/capabilities.h).
    bool serverCan(const std::string& capability) const {
        return server_.capabilities.contains(capability);
    }
    double roundTripMs() const { return connection_.roundTripMs(); }
    std::uint64_t receivedBytes() const { return connection_.receivedBytes(); }

    /// The server's list as it came last; empty before. Names alone of a server without
    /// protocol::capability::caseEntries.
    const std::vector<CaseEntry>& cases() const { return cases_; }
    std::uint64_t casesRevision() const { return casesRevision_; }  ///< of another list another
    std::vector<std::string> caseNames() const;
    /// Asks for it, whatever is open. Returns the request's number.
    std::uint64_t requestCases();
    std::uint64_t answeredCasesRequest() const { return answeredCases_; }
    /// Whether a case that the server refuses to open, or loses, leads back to the list of cases,
    /// with a refusal; else it ends the session.
    void setOffersCases(bool offers) { offersCases_ = offers; }
    bool offersCases() const { return offersCases_; }
    /// An empty name: none, back to the list of cases.
    void openCase(const std::string& name);
    /// The case that is open or to be opened; empty: none.
    const std::string& wantedCase() const { return caseName_; }
    /// The open case; empty before. Its address changes only when a case is opened.
    const std::shared_ptr<const CaseInfo>& caseInfo() const { return caseInfo_; }

    /// Each of these returns the sequence number that the answering picture will reach. They may
    /// be called in any phase: what is asked for early is sent when the case is open.
    /// `lens`: only of a server with protocol::capability::lens; it is not told to another.
    std::uint64_t setViewport(int viewport, View view, int width, int height, bool lens = false);
    /// Where it looks. Windows of grey values go by setWindowLevel.
    std::uint64_t look(int viewport, const ViewState& state, bool moving);
    std::uint64_t setWindowLevel(int viewport, const WindowLevel& window);
    std::uint64_t setTransferFunction(int viewport, const OpticsChoice& optics);

    /// For how long the server has owed a picture or an answer that it has been asked for over this
    /// link; 0 where it owes none.
    std::chrono::seconds overdue() const;
    /// The same of one viewport's picture.
    Clock::duration overdue(int viewport) const;

    /// What colours the wall, in all viewports that show it. Of a case that has been flattened.
    std::uint64_t setWallPaint(const WallPaintChoice& paint);
    const WallPaintChoice& wallPaint() const { return paint_; }
    /// When findings are listed and painted, of the open case: `off` when it is opened. Asks for
    /// the list anew. Returns a sequence as setWallPaint does. Of a server that has
    /// protocol::capability::findings.
    std::uint64_t setDetection(const DetectionChoice& choice);
    const DetectionChoice& detection() const { return detection_; }
    /// As the server told it last; empty before it has. It is asked for when a case with findings
    /// is open, and at each choice.
    const std::optional<FindingList>& findings() const { return findings_; }
    std::uint64_t findingsRevision() const {
        return findingsRevision_;
    }  ///< of another list another
    /// Returns the request's number.
    std::uint64_t requestFindings();
    std::uint64_t answeredFindingsRequest() const { return answeredFindings_; }

    // ---- what has been seen. With a server that has protocol::capability::ledger it is what the
    // reader (ConnectionOptions::reader) has had on screen, in all sessions; with another, what
    // endoscopic pictures of this link have shown.

    /// A picture is on the reader's screen, until another of its viewport is, or it is hidden. Told
    /// to the server ten times a second. One of a former link, or of a case that is left, is not.
    void onScreen(const tiles::Picture& picture);
    void offScreen(int viewport);
    /// Tells what has not been told yet, now. Returns the number of what was told last.
    std::uint64_t tellShown();
    /// What was told to have been on screen since the last call, with logsShown(true) alone.
    std::vector<ShownTime> takeTold() { return std::exchange(told_, {}); }
    void setLogsShown(bool logs) { logsShown_ = logs; }

    /// Of the wall's area, 0…1, as the server told last. None before it has: it is asked when a
    /// case is open, and again after a lost link.
    std::optional<double> seenShare() const { return seenShare_; }
    /// Whether the server keeps it for the reader's next session.
    bool seenIsRecorded() const { return seenIsRecorded_; }
    /// Up to which tellShown() all is on the server's stable storage, where it is kept.
    std::uint64_t keptShown() const { return keptShown_; }
    /// Something was told that is to be kept, and is not yet.
    bool owesShown() const { return seenIsRecorded_ && shownNumber_ > keptShown_; }
    /// By which the server counts, as it told last.
    const std::optional<SeenLimits>& seenLimits() const { return seenLimits_; }
    /// Asks for the share, of all that has been told so far; with `forget`, nothing has been seen.
    /// Returns the request's number.
    std::uint64_t askSeen(bool forget);
    /// From now on, in all cases, it counts by these. Another ledger goes on or begins. As askSeen.
    std::uint64_t setSeenLimits(const SeenLimits& limits);
    std::uint64_t answeredSeenRequest() const { return answeredSeen_; }

    /// Each asks, and returns the request's number; the newest answer is kept. Of a server without
    /// protocol::capability::ledger the answer is a refusal of the client's own, after which there
    /// is none.
    std::uint64_t requestMissed(double leastMm2 = leastMissedMm2);
    std::uint64_t requestLedger();
    std::uint64_t requestSeenReport(double leastMm2 = leastMissedMm2);
    const std::optional<MissedList>& missed() const { return missed_; }
    std::uint64_t missedRevision() const { return missedRevision_; }  ///< of another list another
    const std::optional<LedgerFlags>& ledger() const { return ledger_; }
    const std::optional<SeenReport>& seenReport() const { return seenReport_; }
    /// Whether one of these three still waits for its answer; once refused there is none.
    bool awaits(std::uint64_t request) const { return questions_.contains(request); }

    /// Pictures finished since the last call, oldest first. At most the 64 newest are kept.
    std::deque<link::PictureDone> takePictures() { return std::exchange(arrivals_, {}); }
    /// What the server refused since the last call, or the journal's disk; the session goes on. Of
    /// many the first 16.
    std::vector<Error> takeRefusals() { return std::exchange(refusals_, {}); }

    /// Returns the bookmark's client key. `note` is cut to protocol::maxNoteBytes.
    std::string addBookmark(const Camera& camera, double arcMm, std::string note);
    /// Returns the request's number; after a reconnection the list is asked for anew.
    std::uint64_t requestBookmarks();
    /// Those of other sessions appear by themselves, where the server has
    /// protocol::capability::bookmarkPush; else with the next list. Acknowledged ones first, in the
    /// server's order, then those still owed.
    std::vector<Bookmark> bookmarks() const;
    /// Another one where bookmarks() or refusedBookmarks() may tell something else.
    std::uint64_t bookmarksRevision() const { return bookmarksRevision_; }
    /// Those that the server saved or refused since the last call. Of a refusal, takeRefusals() has
    /// the server's reason.
    std::vector<BookmarkOutcome> takeBookmarkOutcomes() {
        return std::exchange(bookmarkOutcomes_, {});
    }
    /// Those of the open case that the server refused and the reader has not dealt with. A journal
    /// brings those of earlier sessions too.
    std::vector<RefusedBookmark> refusedBookmarks() const;
    void dismissRefused(const std::string& clientKey);
    /// Returns the key under which it is sent: another one where the note is another, since a
    /// server keeps what it has under a key. Empty where no such bookmark is refused.
    std::string sendRefusedAgain(const std::string& clientKey, std::string note);
    const Bookmark* acknowledgedBookmark(const std::string& clientKey) const;
    /// Of the open case, or of the one that is being opened.
    std::size_t owedBookmarks() const;
    /// Owed and refused ones, of all cases, that no disk has: they are lost with this session.
    std::size_t unkeptBookmarks() const;
    /// Number of the newest requestBookmarks that was answered.
    std::uint64_t answeredBookmarkRequest() const { return answeredList_; }

    /// Questions about the wall; each returns its request's number. What has no answer when the
    /// link is lost is asked again when it is back, and counts as refused when that too is lost: it
    /// may be why. Another case forgets it.
    std::uint64_t locate(glm::dvec2 flat);
    std::uint64_t locate(glm::dvec3 positionMm);
    std::uint64_t measure(const std::vector<glm::dvec2>& points, bool closed);
    /// The first place of the wall that a ray from a camera (core's rayThrough) meets. Of any case;
    /// of a server without protocol::capability::pick, as measureScan. Quietly: for what no hand
    /// has asked, so that nobody is told of a refusal.
    std::uint64_t pick(glm::dvec3 positionMm, glm::dvec3 direction, bool quietly = false);
    struct WallAnswer {
        std::uint64_t request;
        Result<std::variant<WallPlace, FlatMeasure>> body;
    };
    /// What has been answered since the last call, or refused.
    std::vector<WallAnswer> takeWallAnswers() { return std::exchange(wallAnswers_, {}); }

    /// Asks for the scan's values there; as a question about the wall is kept and asked again. Of
    /// a server without protocol::capability::scanValues the answer is a refusal of the client's
    /// own.
    std::uint64_t measureScan(const ScanRegion& region);
    struct ScanAnswer {
        std::uint64_t request;
        Result<ScanStatistics> values;
    };
    /// What has been answered since the last call, or refused.
    std::vector<ScanAnswer> takeScanAnswers() { return std::exchange(scanAnswers_, {}); }

private:
    struct ViewportState {
        View view = View::endoscopic;
        int width = 0, height = 0;
        bool lens = false;
        // In the order in which the server hears them again.
        std::optional<WindowLevel> window;
        std::optional<OpticsChoice> optics;
        std::optional<ViewState> state;
        bool moving = false;
        std::uint64_t askedSequence = 0;             // of the newest look that was sent
        std::optional<Clock::time_point> owedSince;  // no picture has answered it
        void asked(std::uint64_t sequence);
    };
    struct Question {
        protocol::ClientMessage message;
        int lostLinks = 0;  // over which it was asked in vain
        Clock::time_point saidAt = {};
        bool quiet = false;  // nobody is told that it was refused
    };
    struct Owed {
        std::string caseName;
        std::optional<std::string> scan;  // that the reader saw; nothing before any case was open
        std::uint64_t request;
        Bookmark bookmark;
        std::int64_t notedMs;      // since 1970
        std::string refusal = {};  // the server's reason, of those in refused_
        bool onDisk = false;       // in the journal, as it is here
    };

    bool isOfOpenCase(const Owed& owed) const;
    void take(const protocol::BookmarkList& message);
    void take(const protocol::FindingList& message);
    bool acknowledge(const protocol::Bookmark& message);
    bool record(Owed& owed);
    void unrecord(const std::string& clientKey);
    void takeFromJournal();
    std::deque<Owed>::iterator findRefused(const std::string& clientKey);
    void handle(link::LinkUp up);
    void handle(const link::LinkDown& down);
    void handle(const protocol::ServerMessage& message);
    void handle(link::PictureDone done);
    void opened(const protocol::CaseOpened& message);
    void refused(const protocol::ErrorReport& report);
    void refuse(std::uint64_t request, const Error& error);
    void dropQuestionsOfLostLinks();
    void settle(std::deque<Owed>::iterator owed, bool saved);
    std::uint64_t ask(const protocol::ClientMessage& question);
    template <class Message, class Body, class Answer>
    void answered(const Message& message, Result<Body> body, std::vector<Answer>& answers);
    void say(std::uint64_t request);
    bool refuseQuestion(std::uint64_t request, const Error& error);
    void askForCase();
    void sayListCases();
    void askAgain();
    void giveUp(Error error);
    void sayWhatWaited(int viewport, ViewportState& state);
    void take(const protocol::WallSeen& message);
    template <class Message, class Body>
    void keep(const Message& message, Result<Body> body, std::optional<Body>& kept);
    void forgetSeen();
    void sendIfOpen(const protocol::ClientMessage& message);

    Phase phase_ = Phase::connecting;
    Error failure_;
    link::LinkUp server_;
    std::string lastWords_;  // why the server ends the link; it is lost next
    std::string caseName_;
    bool offersCases_ = false;
    bool choseAnew_ = false;  // the reader chose it: its address changes, though it is the same
    std::vector<CaseEntry> cases_;
    std::uint64_t casesRevision_ = 0;
    bool linked_ = false;
    std::optional<std::string> opening_;  // asked for over this link, without an answer
    bool refusedOpening_ = false;         // one that was asked for over this link
    std::shared_ptr<const CaseInfo> caseInfo_;

    WallPaintChoice paint_;
    DetectionChoice detection_;
    std::optional<FindingList> findings_;
    std::uint64_t findingsRevision_ = 0, answeredFindings_ = 0;
    std::optional<double> seenShare_;
    bool seenIsRecorded_ = false, logsShown_ = false;
    std::optional<SeenLimits> seenLimits_, chosenLimits_;  // the server's; the reader's choice
    ScreenTime screen_;
    Clock::time_point tellsShownAt_{};
    std::uint64_t sequenceBefore_ = 0;  // of the last input before the case was opened
    std::vector<ShownTime> told_;
    std::uint64_t shownNumber_ = 0, keptShown_ = 0;
    std::optional<MissedList> missed_;
    std::optional<LedgerFlags> ledger_;
    std::optional<SeenReport> seenReport_;
    std::uint64_t missedRevision_ = 0;
    std::uint64_t sequence_ = 0, request_ = 0, answeredList_ = 0, answeredSeen_ = 0,
                  casesAsked_ = 0, answeredCases_ = 0;
    std::map<int, ViewportState> viewports_;
    std::deque<link::PictureDone> arrivals_;
    std::vector<Error> refusals_;
    std::vector<Bookmark> bookmarks_;
    std::unordered_map<std::uint64_t, std::size_t> bookmarkOfId_;  // its place among them
    std::uint64_t bookmarksRevision_ = 0;
    const std::string serverName_;
    std::optional<BookmarkJournal> journal_;
    std::deque<Owed> owed_, refused_;
    std::vector<BookmarkOutcome> bookmarkOutcomes_;
    std::map<std::uint64_t, Question> questions_;  // without an answer, by request
    std::vector<WallAnswer> wallAnswers_;
    std::vector<ScanAnswer> scanAnswers_;

    link::Connection connection_;  // last: its events must not outlive what they change
};

}  // namespace haustra::reader
