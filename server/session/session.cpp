#include "session/session.h"

#include "core/case_name.h"
#include "protocol/capabilities.h"
#include "protocol/view_message.h"
#include "session/case_presets.h"
#include "session/messages.h"
#include "session/worker.h"

#include <algorithm>
#include <cmath>

#include <asio/post.hpp>
#include <spdlog/spdlog.h>

namespace haustra::session {

using protocol::ClientMessage;
using protocol::ErrorReport;
using protocol::ServerMessage;
namespace capability = protocol::capability;

namespace {

ErrorReport::Code codeOf(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::badInput:
            return ErrorReport::BAD_VALUE;
        case ErrorKind::notFound:
            return ErrorReport::NO_SUCH_CASE;
        case ErrorKind::wrongState:
            return ErrorReport::BAD_STATE;
        default:
            return ErrorReport::INTERNAL;
    }
}

}  // namespace

Session::Session(SessionId id, asio::any_io_executor io, const Services& services, Peer peer)
    : id_(id), io_(std::move(io)), services_(services), peer_(std::move(peer)) {}

std::shared_ptr<Session> Session::create(SessionId id, asio::any_io_executor io,
                                         const Services& services, Peer peer) {
    std::shared_ptr<Session> self(new Session(id, io, services, std::move(peer)));
    const std::weak_ptr<Session> weak = self;
    PictureStream::Outlet outlet;
    outlet.send = [weak](std::vector<std::uint8_t> frames) {
        const auto session = weak.lock();
        if (session && session->state_ != State::ended)
            session->peer_.send(std::move(frames), true);
    };
    outlet.failed = [weak](const Error& error) {
        if (const auto session = weak.lock()) session->report(error);
    };
    outlet.broken = [weak](const std::string& what) {
        if (const auto session = weak.lock()) session->broken(what);
    };
    self->pictures_ = std::make_shared<PictureStream>(id, io, services.renderer, services.encoders,
                                                      services.presets, std::move(outlet));
    self->makeKeptShown();
    services.bookmarks.listen(weak, [weak](const BookmarkNews& news) {
        if (const auto session = weak.lock()) session->heard(news);
    });
    services.lostCases.listen(weak, [weak](const std::shared_ptr<const OpenCase>& of) {
        if (const auto session = weak.lock()) session->lost(of);
    });
    return self;
}

// ---- what the connection tells ----------------------------------------------------------------

void Session::receive(std::span<const std::uint8_t> payload) {
    if (state_ == State::ended) return;
    ClientMessage message;
    if (!message.ParseFromArray(payload.data(), int(payload.size())))
        return end(ErrorReport::BAD_MESSAGE, "a control message cannot be read");
    if (state_ == State::hello) {
        if (!message.has_hello())
            return end(ErrorReport::BAD_STATE, "the first message is not a hello");
        return handle(message.hello());
    }
    dispatch(message);
}

void Session::dispatch(const ClientMessage& message) {
    switch (message.body_case()) {
        case ClientMessage::kHello:
            return end(ErrorReport::BAD_STATE, "a second hello");
        case ClientMessage::kListCases:
            return handle(message.list_cases());
        case ClientMessage::kOpenCase:
            return handle(message.open_case());
        case ClientMessage::kLocateFlat:
            return handleQuestion(message.locate_flat());
        case ClientMessage::kLocatePoint:
            return handleQuestion(message.locate_point());
        case ClientMessage::kMeasureFlat:
            return handleQuestion(message.measure_flat());
        case ClientMessage::kMeasureScan:
            return handleQuestion(message.measure_scan());
        case ClientMessage::kPickWall:
            return handleQuestion(message.pick_wall());
        case ClientMessage::kAddBookmark:
            return handle(message.add_bookmark());
        case ClientMessage::kListBookmarks:
            return handle(message.list_bookmarks());
        case ClientMessage::kSetWallPaint:
            return handle(message.set_wall_paint());
        case ClientMessage::kAskSeen:
            return handle(message.ask_seen());
        case ClientMessage::kTellShown:
            return handle(message.tell_shown());
        case ClientMessage::kSetSeenLimits:
            return handle(message.set_seen_limits());
        case ClientMessage::kListMissed:
            return handle(message.list_missed());
        case ClientMessage::kAskLedger:
            return handle(message.ask_ledger());
        case ClientMessage::kAskSeenReport:
            return handle(message.ask_seen_report());
        case ClientMessage::kSetDetection:
            return handle(message.set_detection());
        case ClientMessage::kListFindings:
            return handle(message.list_findings());
        case ClientMessage::kPing:
            return handle(message.ping());
        default:
            if (protocol::inputHeader(message)) return handleInput(message);
    }
    end(ErrorReport::BAD_MESSAGE, "a control message says nothing that this version knows");
}

void Session::pictureSent() {
    if (state_ != State::ended) pictures_->pictureSent();
}

void Session::end(ErrorReport::Code code, const std::string& message) {
    if (state_ == State::ended) return;
    spdlog::info("session {} is ended: {}", id_, message);
    send(errorMessage(code, message, true));
    disconnected();
    peer_.endAfterSending();
}

void Session::disconnected() {
    state_ = State::ended;
    pictures_->stop();
    reading_.reset();
    kept_.reset();
    case_.reset();
    counted_.reset();
    questions_.clear();
    reports_.clear();
}

void Session::broken(const std::string& what) {
    spdlog::error("session {} fails: {}", id_, what);
    end(ErrorReport::INTERNAL, "the server failed");
}

// ---- requests ---------------------------------------------------------------------------------

void Session::handle(const protocol::Hello& hello) {
    if (hello.protocol_version() != protocol::protocolVersion)
        return end(ErrorReport::VERSION,
                   "this server speaks version " + std::to_string(protocol::protocolVersion));
    const auto can = [&](const char* capability) {
        const auto& all = hello.capabilities();
        return std::find(all.begin(), all.end(), capability) != all.end();
    };
    if (!can(capability::lossless))
        return end(ErrorReport::VERSION, "a client without \"lossless\" cannot show exact stills");
    pictures_->setJpeg(can(capability::jpeg));
    pictures_->setCoarse(can(capability::coarse));
    takesBookmarks_ = can(capability::bookmarkPush);
    tellsShown_ = can(capability::ledger);
    pictures_->setTellsShown(tellsShown_);
    if (!hello.reader().empty()) {
        const auto reader = readerFrom(hello.reader());
        if (!reader) return end(ErrorReport::BAD_MESSAGE, describe(reader.error()));
        if (tellsShown_) reader_ = *reader;
    }
    if (!peer_.admit()) return end(ErrorReport::BUSY, "the server has no room left");
    // What such a client has been sent has been seen.
    if (!tellsShown_) seenLimits_.leastMs = 0;
    state_ = State::ready;
    ServerMessage answer;
    auto* welcome = answer.mutable_welcome();
    welcome->set_protocol_version(protocol::protocolVersion);
    for (const char* known : {capability::jpeg, capability::lossless, capability::coarse,
                              capability::slabs, capability::bookmarkPush, capability::marks,
                              capability::caseEntries, capability::scanValues, capability::pick,
                              capability::lens, capability::findings, capability::ledger})
        welcome->add_capabilities(known);
    welcome->set_software(services_.software);
    welcome->set_renderer(services_.renderer.renderer());
    send(answer);
}

template <class T>
auto Session::answer(void (Session::*then)(std::uint64_t, Result<T>), std::uint64_t request,
                     int weight) {
    unanswered_ += weight;
    return [weak = weak_from_this(), io = io_, then, request, weight](Result<T> result) {
        postTo(io, weak,
               [then, request, weight, result = std::move(result)](Session& self) mutable {
                   self.unanswered_ -= weight;
                   if (self.state_ == State::ended) return;
                   (self.*then)(request, std::move(result));
                   self.peer_.answered();
               });
    };
}

void Session::handle(const protocol::ListCases& message) {
    services_.records.listCases(
        id_, answer(&Session::listedCases, message.request(), protocol::listWeight));
}

void Session::listedCases(std::uint64_t request, Result<std::vector<CaseSummary>> cases) {
    if (!cases) return report(cases.error(), request);
    send(caseListMessage(*cases, services_.readers, request));
}

void Session::handle(const protocol::OpenCase& message) {
    if (state_ == State::opening)
        return refuse(ErrorReport::BAD_STATE, "another case is being opened");
    if (!isCaseName(message.name()))
        return refuse(ErrorReport::NO_SUCH_CASE, "this is no case's name");
    leaveCase();
    state_ = State::opening;
    services_.loader.openCase(
        message.name(), weak_from_this(), [weak = weak_from_this(), io = io_](auto result) {
            postTo(io, weak, [result = std::move(result)](Session& self) mutable {
                self.opened(std::move(result));
            });
        });
}

void Session::leaveCase() {
    state_ = State::ready;
    case_.reset();
    counted_.reset();
    reading_.reset();
    kept_->caseLeft();
    detection_ = {};
    pictures_->setCase(nullptr);
}

void Session::lost(const std::shared_ptr<const OpenCase>& of) {
    if (state_ != State::open || case_ != of) return;
    spdlog::error("session {} has lost its case: files cut short, or a failing disk", id_);
    leaveCase();
    refuse(ErrorReport::CASE_LOST,
           "the case is closed: its files were cut short, or their disk fails");
}

void Session::opened(Result<std::shared_ptr<const OpenCase>> result) {
    if (state_ != State::opening) return;
    if (!result) {
        state_ = State::ready;
        // To the client a damaged file is the server's failure, not a bad value of its own.
        Error error = result.error();
        if (error.kind != ErrorKind::notFound) error.kind = ErrorKind::io;
        return report(error);
    }
    state_ = State::open;
    case_ = std::move(*result);
    counted_ = services_.readers.enter(case_->name);
    newestHeard_ = 0;
    pictures_->setCase(case_);
    if (case_->wall) makeReading();
    spdlog::info("session {} has a case open", id_);
    send(caseOpenedMessage(*case_, withPresetOfCase(services_.presets, case_->scanBiopsy)));
}

void Session::handleInput(const ClientMessage& message) {
    if (state_ != State::open) return refuse(ErrorReport::BAD_STATE, "no case is open");
    if (const auto taken = pictures_->input(message); !taken) report(taken.error());
}

// ---- questions, and the wall
// -----------------------------------------------------------------------------------

template <class Question>
void Session::handleQuestion(const Question& message) {
    const std::uint64_t request = message.request();
    if (state_ != State::open) return refuse(ErrorReport::BAD_STATE, "no case is open", request);
    if (asksAboutStrip(message) && !case_->wall)
        return refuse(ErrorReport::BAD_VALUE, "the case has not been flattened", request);
    auto question = questionFrom(message, *case_);
    if (!question) return report(question.error(), request);
    questions_.push_back({case_, std::move(*question),
                          answer(&Session::answeredQuestion, request, weightOf(message))});
    if (!asking_) askNext();
}

void Session::askNext() {
    asking_ = !questions_.empty();
    if (!asking_) return;
    services_.questions.push(std::move(questions_.front()));
    questions_.pop_front();
}

void Session::answeredQuestion(std::uint64_t request, Result<CaseAnswer> answer) {
    if (answer)
        send(messageOf(*answer, request));
    else
        report(answer.error(), request);
    askNext();
}

void Session::makeReading() {
    const std::weak_ptr<Session> weak = weak_from_this();
    WallReading::Outlet outlet;
    outlet.painted = [weak] {
        if (const auto session = weak.lock()) session->pictures_->repaint();
    };
    outlet.seen = [weak](double share) {
        if (const auto session = weak.lock()) session->heardSeen(share);
    };
    outlet.unkept = [weak](const Error& error) {
        if (const auto session = weak.lock()) session->report(error);
    };
    outlet.broken = [weak](const std::string& what) {
        if (const auto session = weak.lock()) session->broken(what);
    };
    ++readings_;
    reading_ =
        std::make_shared<WallReading>(io_, services_.painting, case_, kept_, std::move(outlet));
    reading_->setLedger(services_.ledgers.of(reader_, *case_, seenLimits_));
    reading_->choose({});
    pictures_->setReading(reading_);
    toldShare_ = 0.0;
}

void Session::makeKeptShown() {
    const std::weak_ptr<Session> weak = weak_from_this();
    KeptShown::Outlet outlet;
    outlet.rose = [weak] {
        const auto session = weak.lock();
        if (!session || !session->reading_) return;
        SeenLedger& ledger = session->reading_->ledger();
        ledger.ask([weak, of = ledger.weak_from_this()](Result<double> share) {
            const auto self = weak.lock();
            const bool isRead =
                self && self->reading_ && &self->reading_->ledger() == of.lock().get();
            if (isRead && share) self->heardSeen(*share);
        });
    };
    outlet.notWritten = [weak](const Error& error) {
        if (const auto session = weak.lock()) session->report(error);
    };
    kept_ = std::make_shared<KeptShown>(std::move(outlet));
}

void Session::handle(const protocol::SetWallPaint& message) {
    if (state_ != State::open) return refuse(ErrorReport::BAD_STATE, "no case is open");
    if (const auto taken = pictures_->input(message); !taken) return report(taken.error());
    if (message.marks())
        services_.records.list(id_, case_->name, case_->scan,
                               answer(&Session::listedToPaint, readings_, protocol::listWeight));
}

void Session::listedToPaint(std::uint64_t ofReading,
                            Result<std::vector<records::Bookmark>> bookmarks) {
    if (!reading_ || ofReading != readings_) return;
    if (!bookmarks) report(bookmarks.error());
    reading_->setBookmarks(bookmarks.value_or(std::vector<records::Bookmark>()));
}

// ---- what has been seen -------------------------------------------------------------------------

bool Session::refuseWithoutWall(std::uint64_t request) {
    if (state_ != State::open)
        refuse(ErrorReport::BAD_STATE, "no case is open", request);
    else if (!reading_)
        refuse(ErrorReport::BAD_VALUE, "the case has not been flattened", request);
    return state_ != State::open || !reading_;
}

template <class T, class Then>
std::function<void(Result<T>)> Session::ofLedger(std::uint64_t request, Then then, int weight) {
    unanswered_ += weight;
    return [weak = weak_from_this(), request, then = std::move(then), weight](Result<T> result) {
        const auto self = weak.lock();
        if (!self) return;
        self->unanswered_ -= weight;
        if (self->state_ == State::ended) return;
        if (!result)
            self->report(result.error(), request);
        else
            then(*self, std::move(*result));
        self->peer_.answered();
    };
}

// It may tell of a case that is left.
void Session::handle(const protocol::TellShown& message) {
    if (state_ == State::ready || state_ == State::opening) return;
    if (const auto taken = pictures_->shown(message); !taken) report(taken.error());
}

void Session::handle(const protocol::AskSeen& message) {
    const std::uint64_t request = message.request();
    if (refuseWithoutWall(request)) return;
    const auto tell = [request](Session& self, double share) {
        self.toldShare_ = share;
        self.tellSeen(request, share);
    };
    if (message.forget())
        reading_->forget(ofLedger<double>(request, tell));
    else
        reading_->ledger().ask(ofLedger<double>(request, tell, 1));
}

void Session::handle(const protocol::SetSeenLimits& message) {
    const std::uint64_t request = message.request();
    if (refuseWithoutWall(request)) return;
    const auto limits = seenLimitsFrom(message);
    if (!limits) return report(limits.error(), request);
    seenLimits_ = *limits;
    reading_->setLedger(services_.ledgers.of(reader_, *case_, seenLimits_));
    reading_->ledger().ask(ofLedger<double>(
        request, [request](Session& self, double share) { self.tellSeen(request, share); }));
}

void Session::handle(const protocol::ListMissed& message) {
    const std::uint64_t request = message.request();
    if (refuseWithoutWall(request)) return;
    const auto leastMm2 = leastMm2From(message.least_mm2());
    if (!leastMm2) return report(leastMm2.error(), request);
    reading_->ledger().missed(
        *leastMm2, ofLedger<Missed>(
                       request, [request, least = *leastMm2](Session& self, const Missed& missed) {
                           self.send(missedListMessage(missed, least, request));
                       }));
}

void Session::handle(const protocol::AskLedger& message) {
    const std::uint64_t request = message.request();
    if (refuseWithoutWall(request)) return;
    reading_->ledger().flags(ofLedger<SeenFlags>(
        request,
        [request, key = reading_->ledger().key(), recorded = reading_->ledger().isRecorded()](
            Session& self, const SeenFlags& flags) {
            self.send(ledgerMessage(flags, key, recorded, request));
        }));
}

// Those of the records, and the reader's own where it is not in them. After what this ledger has
// taken in has gone to them.
void Session::handle(const protocol::AskSeenReport& message) {
    const std::uint64_t request = message.request();
    if (refuseWithoutWall(request)) return;
    const auto leastMm2 = leastMm2From(message.least_mm2());
    if (!leastMm2) return report(leastMm2.error(), request);
    SeenLedger& ledger = reading_->ledger();
    auto told = ofLedger<std::vector<ReaderSeen>>(
        request, [request, least = *leastMm2, own = ledger.key()](
                     Session& self, const std::vector<ReaderSeen>& readers) {
            self.send(seenReportMessage(readers, own, least, request));
        });
    reports_.push_back({ledger.shared_from_this(), *leastMm2, std::move(told)});
    if (!reporting_) reportNext();
}

// Each holds what all readers of a wall have seen.
void Session::reportNext() {
    reporting_ = !reports_.empty();
    if (!reporting_) return;
    const ReportRequest next = std::move(reports_.front());
    reports_.pop_front();
    next.of->report(
        next.leastMm2, weak_from_this(),
        [weak = weak_from_this(), told = next.told](Result<std::vector<ReaderSeen>> readers) {
            // First: what throws after it is the answer's own fault.
            if (const auto self = weak.lock()) self->reportNext();
            told(std::move(readers));
        });
}

// Older clients are told of what is worth to be read.
void Session::heardSeen(double share) {
    constexpr double worthTelling = 0.005;
    if (!tellsShown_ && std::abs(share - toldShare_) < worthTelling && share != 1.0) return;
    if (!tellsShown_ && share == toldShare_) return;
    toldShare_ = share;
    tellSeen(0, share);
}

void Session::tellSeen(std::uint64_t request, double share) {
    if (!reading_) return;
    const SeenLedger& ledger = reading_->ledger();
    ServerMessage message;
    protocol::WallSeen& seen = *message.mutable_wall_seen();
    seen.set_request(request);
    seen.set_share(share);
    seen.set_recorded(ledger.isRecorded());
    if (ledger.isRecorded()) seen.set_kept(kept_->number());
    fill(*seen.mutable_limits(), ledger.limits());
    send(message);
}

// ---- findings -----------------------------------------------------------------------------------

void Session::handle(const protocol::SetDetection& message) {
    if (state_ != State::open) return refuse(ErrorReport::BAD_STATE, "no case is open");
    const auto choice = pictures_->input(message);
    if (!choice) return report(choice.error());
    detection_ = *choice;
}

void Session::handle(const protocol::ListFindings& message) {
    const std::uint64_t request = message.request();
    if (state_ != State::open) return refuse(ErrorReport::BAD_STATE, "no case is open", request);
    send(findingListMessage(*case_, detection_, request));
}

// ---- bookmarks ----------------------------------------------------------------------------------

void Session::handle(const protocol::AddBookmark& message) {
    const std::uint64_t request = message.request();
    if (state_ != State::open) return refuse(ErrorReport::BAD_STATE, "no case is open", request);
    auto bookmark = bookmarkFrom(message, case_->name, case_->scan);
    if (!bookmark) return report(bookmark.error(), request);
    services_.records.add(
        id_, std::move(*bookmark),
        [io = io_, &news = services_.bookmarks, of = case_, by = id_,
         told = answer(&Session::addedBookmark, request)](Result<records::Bookmark> added) {
            auto one = guarded(
                [&]() -> Result<MarkedBookmark> { return marked(TRY(std::move(added)), *of); });
            // Others show it, whether or not this session is still there.
            if (one)
                asio::post(io, [&news, told = BookmarkNews{*one, of, by}] { news.tell(told); });
            told(std::move(one));
        });
}

void Session::addedBookmark(std::uint64_t request, Result<MarkedBookmark> bookmark) {
    if (!bookmark) return report(bookmark.error(), request);
    send(bookmarkAddedMessage(*bookmark, request));
}

// Bookmarks become known in the order of their numbers; one that is added again is not told again.
void Session::heard(const BookmarkNews& news) {
    const records::Bookmark& bookmark = news.added.bookmark;
    if (state_ != State::open || bookmark.scan != case_->scan) return;
    if (reading_) reading_->addBookmark(bookmark);
    if (bookmark.id <= newestHeard_) return;
    newestHeard_ = bookmark.id;
    if (!takesBookmarks_ || news.by == id_) return;
    send(bookmarkAddedMessage(news.of->wall == case_->wall ? news.added : marked(bookmark, *case_),
                              0));
}

void Session::handle(const protocol::ListBookmarks& message) {
    const std::uint64_t request = message.request();
    if (state_ != State::open) return refuse(ErrorReport::BAD_STATE, "no case is open", request);
    services_.records.list(
        id_, case_->name, case_->scan,
        [of = case_, told = answer(&Session::listedBookmarks, request, protocol::listWeight)](
            Result<std::vector<records::Bookmark>> listed) {
            told(guarded([&]() -> Result<std::vector<MarkedBookmark>> {
                std::vector<MarkedBookmark> all;
                auto bookmarks = TRY(std::move(listed));
                for (records::Bookmark& bookmark : bookmarks)
                    all.push_back(marked(std::move(bookmark), *of));
                return all;
            }));
        });
}

void Session::listedBookmarks(std::uint64_t request,
                              Result<std::vector<MarkedBookmark>> bookmarks) {
    if (!bookmarks) return report(bookmarks.error(), request);
    ServerMessage message;
    message.mutable_bookmark_list()->set_request(request);
    for (const MarkedBookmark& bookmark : *bookmarks)
        fill(*message.mutable_bookmark_list()->add_bookmarks(), bookmark);
    send(message);
}

void Session::handle(const protocol::Ping& message) {
    ServerMessage answer;
    answer.mutable_pong()->set_request(message.request());
    send(answer);
}

// ---- answers ----------------------------------------------------------------------------------

void Session::send(const ServerMessage& message) {
    if (state_ != State::ended) peer_.send(frameOf(message), false);
}

void Session::refuse(ErrorReport::Code code, const std::string& message, std::uint64_t request) {
    send(errorMessage(code, message, false, request));
}

void Session::report(const Error& error, std::uint64_t request) {
    const auto code = codeOf(error.kind);
    if (code == ErrorReport::INTERNAL) spdlog::error("session {}: {}", id_, error.message);
    // Where the server keeps its files is not a client's to know; which field it got wrong is.
    const bool ofFiles = code == ErrorReport::INTERNAL || code == ErrorReport::NO_SUCH_CASE;
    refuse(code, ofFiles ? error.message : describe(error), request);
}

}  // namespace haustra::session
