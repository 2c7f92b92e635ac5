// One client's session: the states and answers of PROTOCOL.md §2 and §4.
#pragma once

#include "protocol/haustra.pb.h"
#include "session/case_list.h"
#include "session/case_loader.h"
#include "session/case_questions.h"
#include "session/kept_shown.h"
#include "session/marked_bookmark.h"
#include "session/news.h"
#include "session/picture_stream.h"
#include "session/records_thread.h"
#include "session/render_thread.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <asio/any_io_executor.hpp>

namespace haustra::session {

/// What sessions use together. Outlives them all.
struct Services {
    RenderThread& renderer;
    CaseLoader& loader;
    EncoderThreads& encoders;
    RecordsThread& records;
    QuestionThread& questions;
    PaintThread& painting;
    SeenLedgers& ledgers;
    News<BookmarkNews>& bookmarks;
    News<std::shared_ptr<const OpenCase>>& lostCases;  ///< whose files cannot be read any more
    OpenCounts& readers;                               ///< of each case
    const render::PresetLibrary& presets;              ///< not empty
    std::string software;                              ///< name and version, for the welcome
};

/// The session's side of a connection. Called on the io thread.
struct Peer {
    std::function<bool()> admit;  ///< after a good hello, once: no is answered by BUSY
    std::function<void(std::vector<std::uint8_t> frames, bool picture)> send;
    std::function<void()> endAfterSending;  ///< the session is over
    std::function<void()> answered;         ///< tooBusy() may have become false
};

/// Belongs to the io thread. Whatever the bytes, a violation costs this session alone.
class Session : public std::enable_shared_from_this<Session> {
public:
    static std::shared_ptr<Session> create(SessionId id, asio::any_io_executor io,
                                           const Services& services, Peer peer);

    /// A control frame's payload.
    void receive(std::span<const std::uint8_t> payload);
    /// A picture given to Peer::send has left.
    void pictureSent();
    /// Ends the session with a last, fatal error.
    void end(protocol::ErrorReport::Code code, const std::string& message);
    /// The connection is gone; the peer is not used again.
    void disconnected();
    /// Ends the session after a fault of the server's own.
    void broken(const std::string& what);

    bool greeted() const { return state_ != State::hello; }
    /// So many requests wait for their answer that no more should be read.
    bool tooBusy() const { return unanswered_ >= protocol::maxUnanswered; }

private:
    enum class State { hello, ready, opening, open, ended };

    Session(SessionId id, asio::any_io_executor io, const Services& services, Peer peer);
    void handle(const protocol::Hello& hello);
    void handle(const protocol::ListCases& message);
    void handle(const protocol::OpenCase& message);
    void handle(const protocol::AddBookmark& message);
    void handle(const protocol::ListBookmarks& message);
    void handle(const protocol::SetWallPaint& message);
    void handle(const protocol::AskSeen& message);
    void handle(const protocol::TellShown& message);
    void handle(const protocol::SetSeenLimits& message);
    void handle(const protocol::ListMissed& message);
    void handle(const protocol::AskLedger& message);
    void handle(const protocol::AskSeenReport& message);
    void handle(const protocol::SetDetection& message);
    void handle(const protocol::ListFindings& message);
    void handle(const protocol::Ping& message);
    void handleInput(const protocol::ClientMessage& message);
    template <class Question>
    void handleQuestion(const Question& message);
    void askNext();
    void reportNext();
    void answeredQuestion(std::uint64_t request, Result<CaseAnswer> answer);
    void opened(Result<std::shared_ptr<const OpenCase>> result);
    void leaveCase();
    void lost(const std::shared_ptr<const OpenCase>& of);

    void dispatch(const protocol::ClientMessage& message);
    void send(const protocol::ServerMessage& message);
    void report(const Error& error, std::uint64_t request = 0);
    void refuse(protocol::ErrorReport::Code code, const std::string& message,
                std::uint64_t request = 0);
    /// A callback for another thread: its result comes to `then` on the io thread, if the session
    /// still lives.
    template <class T>
    auto answer(void (Session::*then)(std::uint64_t request, Result<T>), std::uint64_t request,
                int weight = 1);
    void listedCases(std::uint64_t request, Result<std::vector<CaseSummary>> cases);
    void addedBookmark(std::uint64_t request, Result<MarkedBookmark> bookmark);
    void heard(const BookmarkNews& news);
    void listedBookmarks(std::uint64_t request, Result<std::vector<MarkedBookmark>> bookmarks);
    void makeReading();
    void makeKeptShown();
    void listedToPaint(std::uint64_t ofReading, Result<std::vector<records::Bookmark>> bookmarks);
    void heardSeen(double share);
    void tellSeen(std::uint64_t request, double share);
    bool refuseWithoutWall(std::uint64_t request);
    /// A callback of the reading's ledger: its result comes to `then` if the session still lives.
    template <class T, class Then>
    std::function<void(Result<T>)> ofLedger(std::uint64_t request, Then then,
                                            int weight = protocol::listWeight);

    const SessionId id_;
    asio::any_io_executor io_;
    const Services& services_;
    Peer peer_;
    State state_ = State::hello;
    bool takesBookmarks_ = false;    // of others, unasked
    std::uint64_t newestHeard_ = 0;  // bookmark of the open case
    std::shared_ptr<const OpenCase> case_;
    std::shared_ptr<const void> counted_;  // while a case is open
    std::shared_ptr<PictureStream> pictures_;
    std::shared_ptr<WallReading> reading_;  // where the open case has been flattened
    std::shared_ptr<KeptShown> kept_;       // of all cases
    std::uint64_t readings_ = 0;
    DetectionChoice detection_;  // of the open case
    std::string reader_;         // whose ledger it is; empty: nobody's
    bool tellsShown_ = false;
    SeenLimits seenLimits_;
    double toldShare_ = 0.0;  // without being asked, last
    int unanswered_ = 0;

    std::deque<CaseRequest> questions_;  // not yet asked
    bool asking_ = false;
    struct ReportRequest {
        std::shared_ptr<SeenLedger> of;
        double leastMm2;
        std::function<void(Result<std::vector<ReaderSeen>>)> told;
    };
    std::deque<ReportRequest> reports_;  // not yet asked for
    bool reporting_ = false;
};

}  // namespace haustra::session
