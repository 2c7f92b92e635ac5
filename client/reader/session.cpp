#include "reader/session.h"

#include "link/peer_text.h"
#include "protocol/capabilities.h"
#include "protocol/limits.h"
#include "protocol/optics_message.h"
#include "protocol/view_message.h"
#include "reader/incoming_messages.h"
#include "reader/random_key.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace haustra::reader {
namespace {

std::int64_t nowMs() {
    using namespace std::chrono;
    return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

// Cuts at a character's start: protobuf refuses broken UTF-8.
std::string cutUtf8(std::string text, std::size_t maxBytes) {
    if (text.size() <= maxBytes) return text;
    while (maxBytes > 0 && (static_cast<unsigned char>(text[maxBytes]) & 0xC0) == 0x80)
        --maxBytes;
    text.resize(maxBytes);
    return text;
}

bool sameStrip(const std::optional<FlatStrip>& a, const std::optional<FlatStrip>& b) {
    return a.has_value() == b.has_value() &&
           (!a || (a->height == b->height && a->rows.size() == b->rows.size()));
}

// ---- what the session says that is no view (protocol/view_message.h) ------------------------

protocol::ClientMessage opticsMessage(std::uint64_t sequence, int viewport,
                                      const OpticsChoice& optics) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_transfer_function();
    body->set_sequence(sequence);
    body->set_viewport(std::uint32_t(viewport));
    if (const auto* preset = std::get_if<std::string>(&optics)) body->set_preset(*preset);
    if (const auto* own = std::get_if<Optics>(&optics)) fill(*body->mutable_optics(), *own);
    return message;
}

protocol::ClientMessage bookmarkMessage(std::uint64_t request, const Bookmark& bookmark) {
    protocol::ClientMessage message;
    auto* body = message.mutable_add_bookmark();
    body->set_request(request);
    protocol::fillPose(*body, bookmark.camera);
    body->set_arc_mm(bookmark.arcMm);
    body->set_note(bookmark.note);
    body->set_client_key(bookmark.clientKey);
    return message;
}

protocol::ClientMessage locateMessage(std::uint64_t request, glm::dvec2 flat) {
    protocol::ClientMessage message;
    message.mutable_locate_flat()->set_request(request);
    protocol::fill(*message.mutable_locate_flat()->mutable_flat(), flat);
    return message;
}

protocol::ClientMessage locateMessage(std::uint64_t request, glm::dvec3 positionMm) {
    protocol::ClientMessage message;
    message.mutable_locate_point()->set_request(request);
    protocol::fill(*message.mutable_locate_point()->mutable_position_mm(), positionMm);
    return message;
}

protocol::ClientMessage measureMessage(std::uint64_t request, const std::vector<glm::dvec2>& points,
                                       bool closed) {
    protocol::ClientMessage message;
    auto* body = message.mutable_measure_flat();
    body->set_request(request);
    for (const glm::dvec2 point : points)
        protocol::fill(*body->add_points(), point);
    body->set_closed(closed);
    return message;
}

protocol::ClientMessage pickMessage(std::uint64_t request, glm::dvec3 positionMm,
                                    glm::dvec3 direction) {
    protocol::ClientMessage message;
    auto* body = message.mutable_pick_wall();
    body->set_request(request);
    protocol::fill(*body->mutable_position_mm(), positionMm);
    protocol::fill(*body->mutable_direction(), direction);
    return message;
}

protocol::ClientMessage scanMessage(std::uint64_t request, const ScanRegion& region) {
    protocol::ClientMessage message;
    auto* body = message.mutable_measure_scan();
    body->set_request(request);
    protocol::fill(*body->mutable_center_mm(), region.centerMm);
    protocol::fill(*body->mutable_half_a_mm(), region.halfAMm);
    protocol::fill(*body->mutable_half_b_mm(), region.halfBMm);
    body->set_cleansed(region.scan == Scan::cleansed);
    if (region.slab != Slab{}) protocol::fill(*body->mutable_slab(), region.slab);
    return message;
}

/// The capability without which a server does not know a question; null of those that every server
/// knows.
const char* neededBy(const protocol::ClientMessage& question) {
    if (question.has_pick_wall()) return protocol::capability::pick;
    if (question.has_list_findings()) return protocol::capability::findings;
    if (question.has_set_seen_limits() || question.has_list_missed() || question.has_ask_ledger() ||
        question.has_ask_seen_report())
        return protocol::capability::ledger;
    return question.has_measure_scan() ? protocol::capability::scanValues : nullptr;
}

std::string reasonOf(const protocol::ErrorReport& report) {
    const std::string reason = link::peerText(report.message());
    return reason.find_first_not_of(' ') == std::string::npos ? "it gave no reason" : reason;
}

/// The kind of message that answers a question.
protocol::ServerMessage::BodyCase answerOf(const protocol::ClientMessage& question) {
    switch (question.body_case()) {
        case protocol::ClientMessage::kMeasureFlat:
            return protocol::ServerMessage::kFlatMeasure;
        case protocol::ClientMessage::kMeasureScan:
            return protocol::ServerMessage::kScanStatistics;
        case protocol::ClientMessage::kAskSeen:
        case protocol::ClientMessage::kSetSeenLimits:
            return protocol::ServerMessage::kWallSeen;
        case protocol::ClientMessage::kListMissed:
            return protocol::ServerMessage::kMissedList;
        case protocol::ClientMessage::kAskLedger:
            return protocol::ServerMessage::kLedger;
        case protocol::ClientMessage::kAskSeenReport:
            return protocol::ServerMessage::kSeenReport;
        case protocol::ClientMessage::kListFindings:
            return protocol::ServerMessage::kFindingList;
        default:
            return protocol::ServerMessage::kWallPlace;
    }
}

std::uint64_t requestOf(const protocol::ServerMessage& answer) {
    return answer.has_wall_place()        ? answer.wall_place().request()
           : answer.has_flat_measure()    ? answer.flat_measure().request()
           : answer.has_scan_statistics() ? answer.scan_statistics().request()
           : answer.has_wall_seen()       ? answer.wall_seen().request()
           : answer.has_finding_list()    ? answer.finding_list().request()
           : answer.has_missed_list()     ? answer.missed_list().request()
           : answer.has_ledger()          ? answer.ledger().request()
           : answer.has_seen_report()     ? answer.seen_report().request()
                                          : 0;
}

}  // namespace

Session::Session(link::ConnectionOptions options, std::string caseName,
                 std::optional<BookmarkJournal> journal)
    : caseName_(std::move(caseName)),
      serverName_(link::toString(options.address)),
      journal_(std::move(journal)),
      connection_(std::move(options)) {}

void Session::poll(std::chrono::milliseconds patience) {
    if (phase_ == Phase::failed) return;
    // A bound on the time, so that a fast stream cannot keep the caller here.
    constexpr std::chrono::milliseconds longest{10};
    auto event = connection_.next(patience);
    const auto end = Clock::now() + longest;
    for (; event; event = Clock::now() < end ? connection_.next(std::chrono::milliseconds(0))
                                             : std::nullopt) {
        if (auto* up = std::get_if<link::LinkUp>(&*event))
            handle(std::move(*up));
        else if (auto* down = std::get_if<link::LinkDown>(&*event))
            handle(*down);
        else if (auto* done = std::get_if<link::PictureDone>(&*event))
            handle(std::move(*done));
        else
            handle(std::get<protocol::ServerMessage>(*event));
        if (phase_ == Phase::failed) return;
    }
    if (Clock::now() >= tellsShownAt_) tellShown();
}

void Session::handle(link::LinkUp up) {
    server_ = std::move(up);
    lastWords_.clear();
    phase_ = Phase::connecting;
    linked_ = true;
    opening_.reset();
    refusedOpening_ = false;
    askForCase();
    if (!caseName_.empty() && casesAsked_ > answeredCases_) sayListCases();
}

void Session::handle(const link::LinkDown& down) {
    if (phase_ == Phase::open) dropQuestionsOfLostLinks();
    failure_ = down.error;
    // Why it stopped tells more than that it does not answer since, and less than why no further
    // attempt is made.
    if (!lastWords_.empty() && (linked_ || !down.final))
        failure_.message = "the connection was lost: " + lastWords_;
    linked_ = false;
    forgetSeen();
    for (auto& [id, state] : viewports_)
        state.owedSince.reset();
    phase_ = down.final ? Phase::failed : Phase::lost;
}

void Session::handle(const protocol::ServerMessage& message) {
    const auto question = questions_.find(requestOf(message));
    if (question != questions_.end() && answerOf(question->second.message) != message.body_case())
        return giveUp({ErrorKind::badInput, "the server answered what was not asked", "wall"});
    switch (message.body_case()) {
        case protocol::ServerMessage::kCaseList: {
            auto cases = casesFrom(message.case_list());
            if (!cases) return giveUp(cases.error());
            if (*cases != cases_) {
                cases_ = std::move(*cases);
                ++casesRevision_;
                if (std::size_t(message.case_list().names_size()) > cases_.size())
                    refuse(0, {ErrorKind::unsupported,
                               "the server has more cases than can be listed here: the first " +
                                   std::to_string(cases_.size()) + " are",
                               "case list"});
            }
            // An old server does not say which request it answers.
            const std::uint64_t request = message.case_list().request();
            if (request > request_)
                return giveUp(
                    {ErrorKind::badInput, "the server answered what was not asked", "case list"});
            answeredCases_ = std::max(answeredCases_, request != 0 ? request : casesAsked_);
            if (caseName_.empty()) phase_ = Phase::choosing;
            break;
        }
        case protocol::ServerMessage::kCaseOpened:
            opened(message.case_opened());
            break;
        case protocol::ServerMessage::kBookmarkAdded:
            // Another session's, of a case that is left.
            if (message.bookmark_added().request() == 0 && phase_ != Phase::open) break;
            acknowledge(message.bookmark_added().bookmark());
            break;
        case protocol::ServerMessage::kBookmarkList:
            take(message.bookmark_list());
            break;
        case protocol::ServerMessage::kWallPlace:
            answered(message.wall_place(), placeFrom(message.wall_place()), wallAnswers_);
            break;
        case protocol::ServerMessage::kFlatMeasure:
            answered(message.flat_measure(), measureFrom(message.flat_measure()), wallAnswers_);
            break;
        case protocol::ServerMessage::kScanStatistics:
            answered(message.scan_statistics(), statisticsFrom(message.scan_statistics()),
                     scanAnswers_);
            break;
        case protocol::ServerMessage::kWallSeen:
            take(message.wall_seen());
            break;
        case protocol::ServerMessage::kMissedList:
            keep(message.missed_list(), missedFrom(message.missed_list()), missed_);
            ++missedRevision_;
            break;
        case protocol::ServerMessage::kLedger:
            keep(message.ledger(), ledgerFrom(message.ledger()), ledger_);
            break;
        case protocol::ServerMessage::kSeenReport:
            keep(message.seen_report(), seenReportFrom(message.seen_report()), seenReport_);
            break;
        case protocol::ServerMessage::kFindingList:
            take(message.finding_list());
            break;
        case protocol::ServerMessage::kError:
            refused(message.error());
            break;
        default:
            break;  // a newer server may say more than this client understands
    }
}

void Session::opened(const protocol::CaseOpened& message) {
    // What is open must not become another patient's of itself.
    // What was taken for its refusal may have been of something else.
    if (!opening_ && std::exchange(refusedOpening_, false)) return;
    if (!opening_)
        return giveUp({ErrorKind::badInput, "the server opened a case that was not asked for",
                       "case opened"});
    const std::string asked = *std::exchange(opening_, std::nullopt);
    auto info = caseInfoFrom(message);
    if (!info) return giveUp(info.error());
    if (info->name != asked)
        return giveUp({ErrorKind::badInput, "the server opened another case than was asked for",
                       "case opened: name"});
    if (asked != caseName_) {  // the reader has chosen another since, or none
        if (!caseName_.empty()) askForCase();
        return;
    }
    // After a reconnection the same case keeps its address, and the reader's flight with it.
    const bool chosenAnew = std::exchange(choseAnew_, false);
    const bool same =
        !chosenAnew && caseInfo_ && caseInfo_->name == info->name &&
        caseInfo_->scan == info->scan &&
        caseInfo_->centerline.points.size() == info->centerline.points.size() &&
        caseInfo_->cleansed == info->cleansed && caseInfo_->detection == info->detection &&
        sameStrip(caseInfo_->flat, info->flat) && sameGrid(caseInfo_->grid, info->grid);
    if (!same) {
        // What was chosen for a scan, and that its first reading is done, is not another's.
        if (!chosenAnew && caseInfo_ && caseInfo_->scan != info->scan) {
            detection_ = {};
            refusals_.push_back({ErrorKind::badInput,
                                 "the case is of another scan now, perhaps another patient's: it "
                                 "is that one that is read from here on",
                                 info->name});
        }
        findings_.reset();
        ++findingsRevision_;
        caseInfo_ = std::make_shared<const CaseInfo>(std::move(*info));
        ++bookmarksRevision_;
        takeFromJournal();
    }
    if (!serverCan(protocol::capability::findings)) ++findingsRevision_;  // nothing answers here
    phase_ = Phase::open;
    askAgain();
}

void Session::refused(const protocol::ErrorReport& report) {
    // It stops, or has no room: no refusal of what was asked for, which is tried again.
    if (report.fatal() && report.code() == protocol::ErrorReport::BUSY) {
        lastWords_ = reasonOf(report);
        return;
    }
    const std::string reason = reasonOf(report);
    const Error error{ErrorKind::badInput, "the server refused: " + reason, {}};
    const auto owed = std::find_if(owed_.begin(), owed_.end(), [&](const Owed& o) {
        return report.request() != 0 && o.request == report.request();
    });
    if (owed != owed_.end()) {  // it would be sent again for ever
        refused_.push_back(*owed);
        refused_.back().refusal = reason;
        record(refused_.back());
        settle(owed, false);
    }
    // An input's late refusal (BAD_VALUE, BAD_STATE) does not tell of the case that is awaited.
    const bool ofACase = report.code() == protocol::ErrorReport::NO_SUCH_CASE ||
                         report.code() == protocol::ErrorReport::INTERNAL ||
                         report.code() == protocol::ErrorReport::BUSY;
    if (opening_ && report.request() == 0 && ofACase && !report.fatal()) {
        const std::string asked = *std::exchange(opening_, std::nullopt);
        refusedOpening_ = true;
        if (asked != caseName_) {  // the reader has chosen another since, or none
            if (!caseName_.empty()) askForCase();
            return;
        }
    }
    refuse(report.request(), error);
    const bool ofTheCase = ofACase && (report.request() == 0 ||
                                       (caseName_.empty() && report.request() == casesAsked_));
    const bool lost = phase_ == Phase::open && report.code() == protocol::ErrorReport::CASE_LOST;
    if (offersCases_ && !report.fatal() && ((phase_ == Phase::connecting && ofTheCase) || lost)) {
        caseName_.clear();
        phase_ = Phase::choosing;
        requestCases();
    } else if (phase_ == Phase::connecting && (ofTheCase || report.fatal())) {
        giveUp(error);
    } else if (lost) {
        giveUp(error);
    }
}

void Session::refuse(std::uint64_t request, const Error& error) {
    const auto asked = questions_.find(request);
    const bool quiet = asked != questions_.end() && asked->second.quiet;
    refuseQuestion(request, error);
    if (quiet) return;
    // Nobody reads more at a time.
    constexpr std::size_t maxRefusals = 16;
    if (refusals_.size() < maxRefusals) refusals_.push_back(error);
}

// All have been sent over it. A server that ends the link because of one would do so for ever.
void Session::dropQuestionsOfLostLinks() {
    constexpr int maxLostLinks = 2;
    std::vector<std::uint64_t> dropped;
    for (auto& [request, question] : questions_)
        if (++question.lostLinks >= maxLostLinks) dropped.push_back(request);
    for (const std::uint64_t request : dropped)
        refuse(request,
               {ErrorKind::device,
                "the link was lost twice while this was asked: it is not asked again", "wall"});
}

void Session::handle(link::PictureDone done) {
    if (const auto of = viewports_.find(done.picture.viewport); of != viewports_.end()) {
        ViewportState& state = of->second;
        const bool answers = done.picture.sequence >= state.askedSequence;
        if (answers)
            state.owedSince.reset();
        else if (state.owedSince)
            state.owedSince = Clock::now();  // it is on its way to it
    }
    arrivals_.push_back(std::move(done));
    if (arrivals_.size() > 64) arrivals_.pop_front();
}

void Session::giveUp(Error error) {
    failure_ = std::move(error);
    phase_ = Phase::failed;
}

// ---- asking ---------------------------------------------------------------------------------

void Session::askForCase() {
    if (caseName_.empty()) {
        requestCases();
        return;
    }
    if (opening_) return;  // a server opens one case at a time: once that is answered
    protocol::ClientMessage message;
    message.mutable_open_case()->set_name(caseName_);
    opening_ = caseName_;
    connection_.send(message);
}

std::uint64_t Session::requestCases() {
    casesAsked_ = ++request_;
    if (linked_) sayListCases();
    return casesAsked_;
}

void Session::sayListCases() {
    protocol::ClientMessage message;
    message.mutable_list_cases()->set_request(casesAsked_);
    connection_.send(message);
}

std::vector<std::string> Session::caseNames() const {
    std::vector<std::string> names;
    for (const CaseEntry& entry : cases_)
        names.push_back(entry.name);
    return names;
}

void Session::openCase(const std::string& name) {
    caseName_ = name;
    choseAnew_ = true;
    bookmarks_.clear();
    bookmarkOfId_.clear();
    ++bookmarksRevision_;
    viewports_.clear();
    questions_.clear();
    wallAnswers_.clear();
    scanAnswers_.clear();
    paint_ = {};
    detection_ = {};
    findings_.reset();
    ++findingsRevision_;
    tellShown();
    forgetSeen();
    if (phase_ == Phase::failed || phase_ == Phase::lost) return;
    phase_ = Phase::connecting;
    askForCase();
}

// Everything that the server has to know of a session that it sees for the first time.
void Session::askAgain() {
    forgetSeen();
    sequenceBefore_ = sequence_;
    if (caseInfo_->flat && chosenLimits_) setSeenLimits(*chosenLimits_);
    if (caseInfo_->flat && paint_.any())
        connection_.send(protocol::paintMessage(++sequence_, paint_));
    // Its views are opened with the paint that they are to have; the list is asked for after it.
    if (serverCan(protocol::capability::findings) && detection_.mode != DetectionMode::off)
        connection_.send(protocol::detectionMessage(++sequence_, detection_));
    for (auto& [id, state] : viewports_) {
        if (state.width == 0) continue;  // spoken of before it was opened
        // The server may be an older one now.
        if (state.lens && !serverCan(protocol::capability::lens)) continue;
        connection_.send(protocol::viewportMessage({++sequence_, std::uint32_t(id)}, state.view,
                                                   state.width, state.height, state.lens));
        sayWhatWaited(id, state);
    }
    std::size_t kept = 0;
    for (const Owed& owed : owed_) {
        if (isOfOpenCase(owed))
            connection_.send(bookmarkMessage(owed.request, owed.bookmark));
        else
            kept += owed.caseName == caseName_;
    }
    for (const Owed& owed : refused_)
        kept += owed.caseName == caseName_ && !isOfOpenCase(owed);
    if (kept > 0)
        refusals_.push_back({ErrorKind::badInput,
                             "the case is of another scan now: " + std::to_string(kept) +
                                 " bookmarks on the former one are not sent",
                             journal_ ? journal_->folder().string() : ""});
    std::vector<std::uint64_t> unanswered;
    for (const auto& [request, question] : questions_)
        unanswered.push_back(request);
    for (const std::uint64_t request : unanswered)
        say(request);
    if (caseInfo_->flat) askSeen(false);
    if (serverCan(protocol::capability::findings) && caseInfo_->detection == Detection::there)
        requestFindings();
    requestBookmarks();
}

void Session::sendIfOpen(const protocol::ClientMessage& message) {
    if (phase_ == Phase::open) connection_.send(message);
}

std::uint64_t Session::setViewport(int viewport, View view, int width, int height, bool lens) {
    ViewportState& state = viewports_[viewport];
    const bool wasOpen = state.width > 0;
    if (wasOpen && (state.view != view || state.lens != lens)) state = {};
    state.view = view;
    state.lens = lens;
    state.width = width;
    state.height = height;
    sendIfOpen(protocol::viewportMessage({++sequence_, std::uint32_t(viewport)}, view, width,
                                         height, lens));
    if (!wasOpen && phase_ == Phase::open) sayWhatWaited(viewport, state);
    if (width == 0 || height == 0) viewports_.erase(viewport);
    return sequence_;
}

// What is said of a viewport before it is open waits in its state.
std::uint64_t Session::look(int viewport, const ViewState& shown, bool moving) {
    ViewportState& state = viewports_[viewport];
    state.state = shown;
    state.moving = moving;
    const protocol::InputHeader header{++sequence_, std::uint32_t(viewport), moving};
    if (state.width > 0) sendIfOpen(protocol::stateMessage(header, shown));
    if (state.width > 0 && phase_ == Phase::open) state.asked(sequence_);
    return sequence_;
}

void Session::ViewportState::asked(std::uint64_t sequence) {
    askedSequence = sequence;
    if (!owedSince) owedSince = Clock::now();
}

std::chrono::seconds Session::overdue() const {
    if (phase_ != Phase::open) return {};
    const auto now = Clock::now();
    auto oldest = now;
    for (const auto& [id, state] : viewports_)
        if (state.owedSince) oldest = std::min(oldest, *state.owedSince);
    for (const auto& [request, question] : questions_)
        oldest = std::min(oldest, question.saidAt);
    return std::chrono::duration_cast<std::chrono::seconds>(now - oldest);
}

Clock::duration Session::overdue(int viewport) const {
    const auto state = viewports_.find(viewport);
    if (phase_ != Phase::open || state == viewports_.end() || !state->second.owedSince) return {};
    return Clock::now() - *state->second.owedSince;
}

std::uint64_t Session::setWindowLevel(int viewport, const WindowLevel& window) {
    ViewportState& state = viewports_[viewport];
    state.window = window;
    const protocol::InputHeader header{++sequence_, std::uint32_t(viewport)};
    if (state.width > 0) sendIfOpen(protocol::windowMessage(header, window));
    return sequence_;
}

std::uint64_t Session::setTransferFunction(int viewport, const OpticsChoice& optics) {
    ViewportState& state = viewports_[viewport];
    state.optics = optics;
    ++sequence_;
    if (state.width > 0) sendIfOpen(opticsMessage(sequence_, viewport, optics));
    return sequence_;
}

void Session::sayWhatWaited(int viewport, ViewportState& state) {
    const auto header = [&] {
        return protocol::InputHeader{++sequence_, std::uint32_t(viewport), state.moving};
    };
    if (state.window) connection_.send(protocol::windowMessage(header(), *state.window));
    if (state.optics) connection_.send(opticsMessage(++sequence_, viewport, *state.optics));
    if (!state.state) return;
    connection_.send(protocol::stateMessage(header(), *state.state));
    state.asked(sequence_);
}

std::uint64_t Session::setWallPaint(const WallPaintChoice& paint) {
    paint_ = paint;
    sendIfOpen(protocol::paintMessage(++sequence_, paint));
    return sequence_;
}

std::uint64_t Session::setDetection(const DetectionChoice& choice) {
    detection_ = choice;
    ++sequence_;
    if (phase_ == Phase::open && serverCan(protocol::capability::findings))
        connection_.send(protocol::detectionMessage(sequence_, choice));
    ++findingsRevision_;  // what was listed may be hidden now
    requestFindings();
    return sequence_;
}

std::uint64_t Session::requestFindings() {
    // One list is enough: an answer to an earlier question tells of a mode that is past.
    std::erase_if(questions_,
                  [](const auto& asked) { return asked.second.message.has_list_findings(); });
    protocol::ClientMessage message;
    message.mutable_list_findings()->set_request(++request_);
    return ask(message);
}

void Session::take(const protocol::FindingList& message) {
    if (questions_.erase(message.request()) == 0) return;  // of a mode or a case that is left
    auto list = findingsFrom(message, caseInfo_->grid);
    if (!list) return giveUp(list.error());
    // What is not to be seen yet is not kept either.
    if (!detection_.shows()) list->findings.clear();
    findings_ = std::move(*list);
    ++findingsRevision_;
    answeredFindings_ = std::max(answeredFindings_, message.request());
}

// ---- the wall -------------------------------------------------------------------------------

std::uint64_t Session::ask(const protocol::ClientMessage& question) {
    questions_[request_] = {question, 0, Clock::now()};
    if (phase_ == Phase::open) say(request_);
    return request_;
}

// A server that does not know a message would end the session.
void Session::say(std::uint64_t request) {
    questions_.at(request).saidAt = Clock::now();
    const protocol::ClientMessage& question = questions_.at(request).message;
    const char* needed = neededBy(question);
    if (!needed || serverCan(needed)) return connection_.send(question);
    refuseQuestion(request, {ErrorKind::unsupported, "the server is too old to answer this", {}});
}

// False where the request is no question that waits for its answer.
bool Session::refuseQuestion(std::uint64_t request, const Error& error) {
    const auto asked = questions_.find(request);
    if (asked == questions_.end()) return false;
    const protocol::ClientMessage& question = asked->second.message;
    if (question.has_list_findings())
        answeredFindings_ = std::max(answeredFindings_, request);
    else if (question.has_ask_seen() || question.has_set_seen_limits())
        answeredSeen_ = std::max(answeredSeen_, request);
    else if (question.has_list_missed())
        missed_.reset(), ++missedRevision_;
    else if (question.has_ask_ledger())
        ledger_.reset();
    else if (question.has_ask_seen_report())
        seenReport_.reset();
    else if (question.has_measure_scan())
        scanAnswers_.push_back({request, tl::make_unexpected(error)});
    else
        wallAnswers_.push_back({request, tl::make_unexpected(error)});
    questions_.erase(asked);
    return true;
}

std::uint64_t Session::locate(glm::dvec2 flat) {
    return ask(locateMessage(++request_, flat));
}
std::uint64_t Session::locate(glm::dvec3 positionMm) {
    return ask(locateMessage(++request_, positionMm));
}
std::uint64_t Session::pick(glm::dvec3 positionMm, glm::dvec3 direction, bool quietly) {
    const std::uint64_t request = ask(pickMessage(++request_, positionMm, direction));
    if (const auto asked = questions_.find(request); asked != questions_.end())
        asked->second.quiet = quietly;
    return request;
}
std::uint64_t Session::askSeen(bool forget) {
    tellShown();
    protocol::ClientMessage message;
    message.mutable_ask_seen()->set_request(++request_);
    message.mutable_ask_seen()->set_forget(forget);
    return ask(message);
}
std::uint64_t Session::measure(const std::vector<glm::dvec2>& points, bool closed) {
    return ask(measureMessage(++request_, points, closed));
}

std::uint64_t Session::measureScan(const ScanRegion& region) {
    return ask(scanMessage(++request_, region));
}

template <class Message, class Body, class Answer>
void Session::answered(const Message& message, Result<Body> body, std::vector<Answer>& answers) {
    if (questions_.erase(message.request()) == 0) return;  // of a case that is left
    if (!body) return giveUp(body.error());
    answers.push_back({message.request(), std::move(*body)});
}

// ---- what has been seen -----------------------------------------------------------------------

void Session::onScreen(const tiles::Picture& picture) {
    if (phase_ == Phase::open && caseInfo_->flat && serverCan(protocol::capability::ledger) &&
        picture.sequence > sequenceBefore_)
        screen_.show(picture.viewport, picture.number, Clock::now());
}
void Session::offScreen(int viewport) {
    screen_.hide(viewport, Clock::now());
}

std::uint64_t Session::tellShown() {
    constexpr std::chrono::milliseconds every{100};
    const auto now = Clock::now();
    tellsShownAt_ = now + every;
    if (phase_ != Phase::open || !caseInfo_->flat || !serverCan(protocol::capability::ledger))
        return shownNumber_;
    for (;;) {
        const auto times = screen_.take(now, protocol::maxShownPictures);
        if (times.empty()) return shownNumber_;
        protocol::ClientMessage message;
        message.mutable_tell_shown()->set_number(++shownNumber_);
        for (const ShownTime& time : times) {
            auto* one = message.mutable_tell_shown()->add_pictures();
            one->set_picture(time.picture);
            one->set_ms(std::uint32_t(time.ms));
        }
        connection_.send(message);
        if (logsShown_) told_.insert(told_.end(), times.begin(), times.end());
    }
}

// Of another link, or another case: the server begins to tell anew.
void Session::forgetSeen() {
    screen_.reset();
    seenShare_.reset();
    seenLimits_.reset();
    seenIsRecorded_ = false;
    keptShown_ = shownNumber_;
    missed_.reset();
    ledger_.reset();
    seenReport_.reset();
    ++missedRevision_;
}

void Session::take(const protocol::WallSeen& message) {
    if (!(message.share() >= 0.0 && message.share() <= 1.0))
        return giveUp({ErrorKind::badInput, "the server sent a share that is none", "wall"});
    if (message.has_limits()) {
        auto limits = seenLimitsFrom(message.limits());
        if (!limits) return giveUp(limits.error());
        seenLimits_ = *limits;
    }
    seenShare_ = message.share();
    seenIsRecorded_ = message.recorded();
    keptShown_ = std::max(keptShown_, std::min(message.kept(), shownNumber_));
    questions_.erase(message.request());
    answeredSeen_ = std::max(answeredSeen_, message.request());
}

template <class Message, class Body>
void Session::keep(const Message& message, Result<Body> body, std::optional<Body>& kept) {
    if (questions_.erase(message.request()) == 0) return;  // of a case that is left
    if (!body) return giveUp(body.error());
    kept = std::move(*body);
}

std::uint64_t Session::setSeenLimits(const SeenLimits& limits) {
    chosenLimits_ = limits;
    tellShown();
    protocol::ClientMessage message;
    message.mutable_set_seen_limits()->set_request(++request_);
    message.mutable_set_seen_limits()->mutable_limits()->set_pixels_per_mm(limits.pixelsPerMm);
    message.mutable_set_seen_limits()->mutable_limits()->set_least_ms(
        std::uint32_t(limits.leastMs));
    return ask(message);
}

std::uint64_t Session::requestMissed(double leastMm2) {
    tellShown();
    protocol::ClientMessage message;
    message.mutable_list_missed()->set_request(++request_);
    message.mutable_list_missed()->set_least_mm2(leastMm2);
    return ask(message);
}
std::uint64_t Session::requestLedger() {
    tellShown();
    protocol::ClientMessage message;
    message.mutable_ask_ledger()->set_request(++request_);
    return ask(message);
}
std::uint64_t Session::requestSeenReport(double leastMm2) {
    tellShown();
    protocol::ClientMessage message;
    message.mutable_ask_seen_report()->set_request(++request_);
    message.mutable_ask_seen_report()->set_least_mm2(leastMm2);
    return ask(message);
}

// ---- bookmarks ------------------------------------------------------------------------------

// One made on a scan that the case is no longer of belongs to another patient, it may be.
bool Session::isOfOpenCase(const Owed& owed) const {
    return owed.caseName == caseName_ &&
           (!caseInfo_ || !owed.scan || *owed.scan == caseInfo_->scan);
}

std::string Session::addBookmark(const Camera& camera, double arcMm, std::string note) {
    Bookmark bookmark;
    bookmark.camera = camera;
    bookmark.arcMm = arcMm;
    bookmark.note = cutUtf8(std::move(note), protocol::maxNoteBytes);
    bookmark.clientKey = randomKey();
    // While another case is being opened, the reader still sees the one before.
    Owed owed{caseName_, std::nullopt, ++request_, bookmark, nowMs()};
    if (caseInfo_) owed.caseName = caseInfo_->name, owed.scan = caseInfo_->scan;
    record(owed);
    owed_.push_back(std::move(owed));
    ++bookmarksRevision_;
    sendIfOpen(bookmarkMessage(request_, bookmark));
    return bookmark.clientKey;
}

std::uint64_t Session::requestBookmarks() {
    protocol::ClientMessage message;
    message.mutable_list_bookmarks()->set_request(++request_);
    sendIfOpen(message);
    return request_;
}

// What is noted before any case is open is recorded, as it is sent, when one is.
bool Session::record(Owed& owed) {
    if (!journal_ || !owed.scan) return true;
    JournalEntry entry{serverName_,  server_.fingerprint, owed.caseName, *owed.scan,
                       owed.notedMs, owed.bookmark,       std::nullopt};
    if (!owed.refusal.empty()) entry.refusal = owed.refusal;
    const auto written = journal_->write(entry);
    owed.onDisk = bool(written);
    if (written) return true;
    refusals_.push_back({written.error().kind,
                         "a bookmark is not on this computer's disk, and is lost with the window "
                         "where the server does not take it: " +
                             written.error().message,
                         written.error().place});
    return false;
}

void Session::unrecord(const std::string& clientKey) {
    if (!journal_) return;
    if (const auto erased = journal_->erase(clientKey); !erased)
        refusals_.push_back(erased.error());
}

// Once for each case that is opened: what this session notes thereafter it knows.
void Session::takeFromJournal() {
    for (Owed& owed : owed_) {
        if (owed.scan || (!owed.caseName.empty() && owed.caseName != caseName_)) continue;
        owed.caseName = caseName_;
        owed.scan = caseInfo_->scan;
        record(owed);
    }
    if (!journal_) return;
    auto contents = journal_->read();
    std::move(contents.errors.begin(), contents.errors.end(), std::back_inserter(refusals_));
    std::size_t ofAnotherCertificate = 0;
    for (JournalEntry& entry : contents.entries) {
        if (entry.server != serverName_ || entry.caseName != caseName_) continue;
        const auto same = [&](const Owed& o) {
            return o.bookmark.clientKey == entry.bookmark.clientKey;
        };
        if (entry.fingerprint != server_.fingerprint)
            ++ofAnotherCertificate;
        else if (std::none_of(owed_.begin(), owed_.end(), same) &&
                 std::none_of(refused_.begin(), refused_.end(), same))
            (entry.refusal ? refused_ : owed_)
                .push_back({std::move(entry.caseName), std::move(entry.scan), ++request_,
                            std::move(entry.bookmark), entry.notedMs, entry.refusal.value_or(""),
                            true});
    }
    if (ofAnotherCertificate > 0)
        refusals_.push_back(
            {ErrorKind::badInput,
             "the server has another certificate now: " + std::to_string(ofAnotherCertificate) +
                 " bookmarks noted under the former one are kept and not sent",
             journal_->folder().string()});
}

std::deque<Session::Owed>::iterator Session::findRefused(const std::string& clientKey) {
    return std::find_if(refused_.begin(), refused_.end(),
                        [&](const Owed& o) { return o.bookmark.clientKey == clientKey; });
}

std::vector<RefusedBookmark> Session::refusedBookmarks() const {
    std::vector<RefusedBookmark> all;
    for (const Owed& owed : refused_)
        if (isOfOpenCase(owed)) all.push_back({owed.bookmark, owed.refusal});
    return all;
}

void Session::dismissRefused(const std::string& clientKey) {
    const auto found = findRefused(clientKey);
    if (found == refused_.end()) return;
    refused_.erase(found);
    ++bookmarksRevision_;
    unrecord(clientKey);
}

std::string Session::sendRefusedAgain(const std::string& clientKey, std::string note) {
    const auto found = findRefused(clientKey);
    if (found == refused_.end() || !isOfOpenCase(*found)) return {};
    Owed owed = std::move(*found);
    refused_.erase(found);
    note = cutUtf8(std::move(note), protocol::maxNoteBytes);
    const bool changed = note != owed.bookmark.note;
    if (changed) {
        owed.bookmark.note = std::move(note);
        owed.bookmark.clientKey = randomKey();
    }
    owed.refusal.clear();
    owed.request = ++request_;
    if (record(owed) && changed) unrecord(clientKey);
    sendIfOpen(bookmarkMessage(owed.request, owed.bookmark));
    owed_.push_back(std::move(owed));
    ++bookmarksRevision_;
    return owed_.back().bookmark.clientKey;
}

void Session::settle(std::deque<Owed>::iterator owed, bool saved) {
    bookmarkOutcomes_.push_back({std::move(owed->bookmark), saved});
    owed_.erase(owed);
    ++bookmarksRevision_;
}

void Session::take(const protocol::BookmarkList& message) {
    bookmarks_.clear();
    bookmarkOfId_.clear();
    ++bookmarksRevision_;
    for (const auto& bookmark : message.bookmarks())
        if (!acknowledge(bookmark)) return;
    answeredList_ = std::max(answeredList_, message.request());
}

// False where the session has given up for it.
bool Session::acknowledge(const protocol::Bookmark& message) {
    auto sound = bookmarkFrom(message);
    if (!sound) return giveUp(sound.error()), false;
    const std::string key = sound->clientKey;
    const auto [place, isNew] = bookmarkOfId_.try_emplace(sound->id, bookmarks_.size());
    if (!isNew) {
        bookmarks_[place->second] = std::move(*sound);
    } else if (bookmarks_.size() < maxScanBookmarks) {
        bookmarks_.push_back(std::move(*sound));
    } else {
        giveUp({ErrorKind::badInput, "the server sent more bookmarks than a scan can have",
                "bookmark"});
        return false;
    }
    ++bookmarksRevision_;
    const auto owed = std::find_if(owed_.begin(), owed_.end(),
                                   [&](const Owed& o) { return o.bookmark.clientKey == key; });
    if (owed != owed_.end()) {
        unrecord(key);
        settle(owed, true);
    }
    dismissRefused(key);  // that another of the user's clients has sent again
    return true;
}

std::vector<Bookmark> Session::bookmarks() const {
    std::vector<Bookmark> all = bookmarks_;
    for (const Owed& owed : owed_)
        if (isOfOpenCase(owed)) all.push_back(owed.bookmark);
    return all;
}

std::size_t Session::unkeptBookmarks() const {
    const auto isUnkept = [](const Owed& owed) { return !owed.onDisk; };
    return std::size_t(std::count_if(owed_.begin(), owed_.end(), isUnkept) +
                       std::count_if(refused_.begin(), refused_.end(), isUnkept));
}

std::size_t Session::owedBookmarks() const {
    return std::size_t(std::count_if(owed_.begin(), owed_.end(),
                                     [this](const Owed& owed) { return isOfOpenCase(owed); }));
}

const Bookmark* Session::acknowledgedBookmark(const std::string& clientKey) const {
    const auto found = std::find_if(bookmarks_.begin(), bookmarks_.end(),
                                    [&](const Bookmark& b) { return b.clientKey == clientKey; });
    return found == bookmarks_.end() ? nullptr : &*found;
}

}  // namespace haustra::reader
