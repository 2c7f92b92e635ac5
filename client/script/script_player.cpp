#include "script/script_player.h"

#include "core/durable_file.h"
#include "core/raycasters.h"
#include "protocol/capabilities.h"
#include "protocol/limits.h"
#include "reader/biopsy_lens.h"
#include "reader/findings_reading.h"
#include "reader/missed_reading.h"
#include "reader/overview_map.h"
#include "reader/seen_lists_json.h"
#include "reader/strip_tour.h"
#include "tiles/png_file.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include <nlohmann/json.hpp>

namespace haustra::reader {
namespace {

using Status = Result<void>;

double msBetween(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
}

// Adds a picture's times to a report.
void count(ActionReport& report, const link::PictureDone& arrival, Clock::time_point askedAt) {
    const tiles::Picture& picture = arrival.picture;
    report.latencyMs.push_back(msBetween(askedAt, arrival.decodedAt));
    report.decodeMs.push_back(picture.decodeMs);
    report.renderMicroseconds.push_back(picture.renderMicroseconds);
    report.encodeMicroseconds.push_back(picture.encodeMicroseconds);
    report.queueMicroseconds.push_back(picture.queueMicroseconds);
    report.raycaster = raycasterName(picture.raycaster);
    report.coarse += picture.coarse;
    report.bytes += picture.wireBytes;
}

/// One script's reader: a flight through the case, and the viewports that the script has opened.
/// The session and the options must outlive it.
class Player {
public:
    Player(Session& session, const PlayOptions& options)
        : session_(session), options_(options), flight_({}) {
        session_.setLogsShown(true);
    }

    /// Waits until the case is open; where none was named, opens the only one.
    Status awaitCase();
    /// As the server told last; none of one that keeps no ledger.
    std::optional<SeenNow> seenNow() const;
    /// Waits until all that has been on screen so far is kept, where it is.
    Status settleShown();
    Status play(const Action& action, ActionReport& report) {
        return std::visit([&](const auto& body) { return run(body, report); }, action.body);
    }

private:
    struct OpenViewport {
        View view;
        int width, height;
        ViewState state;  ///< of an endoscopic one, the flight's camera when it is asked for
    };
    /// A way past equally spaced positions, each of which is asked for and measured.
    struct Course {
        int positions = 0, viewport = 0;
        bool pipelined = false;
        double holdMs = 0.0;
        /// To so much of the way, 0…1; returns the sequence that the picture will reach.
        std::function<std::uint64_t(double)> goTo;
    };

    Status run(const ViewAction&, ActionReport&);
    Status run(const GoAction&, ActionReport&);
    Status run(const FlyAction&, ActionReport&);
    Status run(const StillAction&, ActionReport&);
    Status run(const LensAction&, ActionReport&);
    Status run(const SliceAction&, ActionReport&);
    Status run(const ObliqueAction&, ActionReport&);
    Status run(const OverviewAction&, ActionReport&);
    Status run(const FlatAction&, ActionReport&);
    Status run(const StripAction&, ActionReport&);
    Status run(const FlyOverAction&, ActionReport&);
    Status run(const LocateAction&, ActionReport&);
    Status run(const MeasureAction&, ActionReport&);
    Status run(const PaintAction&, ActionReport&);
    Status run(const SeenAction&, ActionReport&);
    Status run(const SeenLimitsAction&, ActionReport&);
    Status run(const MissedAction&, ActionReport&);
    Status run(const NextMissedAction&, ActionReport&);
    Status run(const LedgerAction&, ActionReport&);
    Status run(const SeenReportAction&, ActionReport&);
    Status run(const DetectionAction&, ActionReport&);
    Status run(const FindingsAction&, ActionReport&);
    Status run(const FindingAction&, ActionReport&);
    Status run(const WindowAction&, ActionReport&);
    Status run(const TransferAction&, ActionReport&);
    Status run(const BookmarkAction&, ActionReport&);
    Status run(const BookmarksAction&, ActionReport&);
    Status run(const WaitAction&, ActionReport&);

    Status travel(const Course&, ActionReport&);
    Status travelStepwise(const Course&, ActionReport&);
    Status travelPipelined(const Course&, ActionReport&);

    OpenViewport& open(int viewport, View view, int width, int height);
    /// As large as it was, or `size`, or as the options say.
    OpenViewport& open(int viewport, View view, std::optional<glm::ivec2> size);
    Status mustBeOpen(int viewport);
    Status mustBeFlattened();
    /// What a view of this size shows where the script has not said anything else.
    ViewState firstState(View view, int width, int height) const;
    ObliqueView obliqueAtCamera() const;
    Overview overviewFromFront(int width, int height) const;
    FlatWindow windowAround(double y, std::optional<double> pixelsPerCircumference,
                            int width) const;
    std::uint64_t ask(int viewport, bool moving);
    Status still(int viewport, const std::string& png, ActionReport& report);
    Status awaitStill(int viewport, std::uint64_t sequence, Clock::time_point askedAt,
                      const std::string& png, ActionReport& report);
    Result<link::PictureDone> awaitPicture(int viewport, std::uint64_t sequence, bool exact);
    Result<Session::WallAnswer> awaitWallAnswer(std::uint64_t request, ActionReport& report);
    Status awaitBookmarkList();
    static tl::unexpected<Error> noLedger();
    Status hold(double ms);
    void show(const link::PictureDone& arrival);
    void log(const std::vector<ShownTime>& told);
    Status awaitThat(const std::function<bool()>& done, const std::string& what);
    Status writeJson(const std::string& file, const std::string& text, ActionReport& report);

    Session& session_;
    const PlayOptions& options_;
    Flight flight_;
    std::map<int, OpenViewport> viewports_;
    std::deque<link::PictureDone> arrivals_;
    MissedReading missed_{session_};
    struct Asked {
        ViewState state;
        std::string optics;
        int width;
    };
    std::map<int, std::map<std::uint64_t, Asked>> asked_;  // by viewport and sequence
    std::map<int, std::string> optics_;                    // presets that were chosen, by viewport
    std::vector<LoggedPicture> log_;                       // of the wall's views
    std::map<std::uint32_t, std::size_t> logged_;          // over this link: number to log_
    std::map<int, int> passedOver_;  // pictures that came while another viewport's was awaited
};

// ---- waiting --------------------------------------------------------------------------------

Status Player::awaitThat(const std::function<bool()>& done, const std::string& what) {
    const auto deadline = Clock::now() + options_.patience;
    for (;;) {
        // Before the success: a refusal may arrive together with the picture that follows it.
        if (const auto refusals = session_.takeRefusals(); !refusals.empty())
            return tl::make_unexpected(refusals.front());
        if (done()) return {};
        if (session_.phase() == Phase::failed) return tl::make_unexpected(session_.failure());
        const auto now = Clock::now();
        if (now >= deadline) {
            const bool lost = session_.phase() == Phase::lost;
            return fail(ErrorKind::device,
                        what + " did not come within " +
                            std::to_string(options_.patience.count() / 1000) + " s" +
                            (lost ? " (" + describe(session_.failure()) + ")" : ""));
        }
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - now);
        session_.poll(
            std::min(left + std::chrono::milliseconds(1), std::chrono::milliseconds(100)));
    }
}

// The list's answer tells that the server has taken in all that was said before, so that a refusal
// names the line that caused it.
Status Player::awaitBookmarkList() {
    const auto request = session_.requestBookmarks();
    return awaitThat([&] { return session_.answeredBookmarkRequest() >= request; },
                     "the list of bookmarks");
}

Status Player::awaitCase() {
    auto known = awaitThat(
        [&] { return session_.phase() == Phase::open || session_.phase() == Phase::choosing; },
        "the case");
    if (!known || session_.phase() == Phase::open) {
        if (known) flight_ = Flight(session_.caseInfo()->centerline);
        return known;
    }
    const std::vector<std::string> names = session_.caseNames();
    if (names.empty()) return fail(ErrorKind::notFound, "the server has no case");
    if (names.size() > 1) {
        std::string list;
        for (const std::string& name : names)
            list += (list.empty() ? "" : ", ") + name;
        return fail(ErrorKind::badInput,
                    "the server has several cases; choose one with --case: " + list);
    }
    session_.openCase(names.front());
    return awaitCase();
}

Result<link::PictureDone> Player::awaitPicture(int viewport, std::uint64_t sequence, bool exact) {
    Result<link::PictureDone> found = fail(ErrorKind::noResult, "");
    const auto look = [&] {
        for (link::PictureDone& arrival : session_.takePictures()) {
            show(arrival);
            arrivals_.push_back(std::move(arrival));
        }
        while (!found && !arrivals_.empty()) {
            const tiles::Picture& picture = arrivals_.front().picture;
            if (picture.viewport == viewport && picture.sequence >= sequence &&
                (picture.exact || !exact))
                found = std::move(arrivals_.front());
            else if (picture.viewport != viewport)
                ++passedOver_[picture.viewport];
            arrivals_.pop_front();
        }
        return bool(found);
    };
    const std::string what = exact ? "the exact picture" : "the picture";
    TRY(awaitThat(look, what + " of viewport " + std::to_string(viewport)));
    return found;
}

// What has come is on the screen of whoever plays.
void Player::show(const link::PictureDone& arrival) {
    const tiles::Picture& picture = arrival.picture;
    session_.onScreen(picture);
    const auto asked = asked_.find(picture.viewport);
    if (asked == asked_.end()) return;
    const auto after = asked->second.upper_bound(picture.sequence);
    if (after == asked->second.begin()) return;
    const Asked& last = std::prev(after)->second;
    // Over another link the server counts anew.
    if (!logged_.empty() && picture.number < logged_.rbegin()->first) logged_.clear();
    logged_[picture.number] = log_.size();
    log_.push_back({picture.viewport,
                    picture.number,
                    {picture.width, picture.height},
                    last.state,
                    last.width,
                    last.optics,
                    0});
}

void Player::log(const std::vector<ShownTime>& told) {
    for (const ShownTime& time : told)
        if (const auto known = logged_.find(time.picture); known != logged_.end())
            log_[known->second].ms += time.ms;
}

// With what is on screen; what comes meanwhile is, too.
Status Player::hold(double ms) {
    const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                          std::chrono::duration<double, std::milli>(ms));
    while (Clock::now() < until) {
        session_.poll(
            std::min(std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()) +
                         std::chrono::milliseconds(1),
                     std::chrono::milliseconds(100)));
        for (link::PictureDone& arrival : session_.takePictures()) {
            show(arrival);
            arrivals_.push_back(std::move(arrival));
        }
        if (session_.phase() == Phase::failed) return tl::make_unexpected(session_.failure());
    }
    return {};
}

Status Player::awaitStill(int viewport, std::uint64_t sequence, Clock::time_point askedAt,
                          const std::string& png, ActionReport& report) {
    auto arrival = TRY(awaitPicture(viewport, sequence, true));
    count(report, arrival, askedAt);
    report.seconds = msBetween(askedAt, arrival.decodedAt) / 1000.0;
    if (png.empty()) return {};
    report.file = png;
    return tiles::writePng(options_.outFolder / png, tiles::rgbOf(arrival.picture),
                           arrival.picture.width, arrival.picture.height);
}

// ---- actions --------------------------------------------------------------------------------

Player::OpenViewport& Player::open(int viewport, View view, int width, int height) {
    const auto found = viewports_.find(viewport);
    if (found != viewports_.end() && found->second.view == view && found->second.width == width &&
        found->second.height == height)
        return found->second;
    session_.setViewport(viewport, view, width, height);
    return viewports_[viewport] = {view, width, height, firstState(view, width, height)};
}

ViewState Player::firstState(View view, int width, int height) const {
    switch (view) {
        case View::endoscopic:
            return flight_.camera();
        case View::axial:
        case View::coronal:
        case View::sagittal:
            return SliceView{view, flight_.camera().positionMm};
        case View::flattened:
            return WholeStrip{};
        case View::flattenedZoom: {
            const auto& strip = session_.caseInfo()->flat;
            return windowAround(strip ? strip->yAtArc(flight_.placeArcMm()) : 0.0, std::nullopt,
                                width);
        }
        case View::oblique:
            return obliqueAtCamera();
        case View::overview:
            return overviewFromFront(width, height);
    }
    return {};
}

Player::OpenViewport& Player::open(int viewport, View view, std::optional<glm::ivec2> size) {
    const auto found = viewports_.find(viewport);
    if (!size && found != viewports_.end() && found->second.view == view) return found->second;
    const glm::ivec2 pixels = size.value_or(glm::ivec2(options_.width, options_.height));
    return open(viewport, view, pixels.x, pixels.y);
}

// Asks for what the viewport is to show now.
std::uint64_t Player::ask(int id, bool moving) {
    OpenViewport& viewport = viewports_.at(id);
    if (viewport.view == View::endoscopic) viewport.state = flight_.camera();
    const auto sequence = session_.look(id, viewport.state, moving);
    if (viewport.view == View::endoscopic || isFlat(viewport.view))
        asked_[id][sequence] = {viewport.state, optics_[id], viewport.width};
    return sequence;
}

Status Player::still(int viewport, const std::string& png, ActionReport& report) {
    const auto askedAt = Clock::now();
    return awaitStill(viewport, ask(viewport, false), askedAt, png, report);
}

// Viewport 0 shows the endoscopic view unless the script says otherwise; others must be opened.
Status Player::mustBeOpen(int viewport) {
    if (viewports_.count(viewport)) return {};
    if (viewport != 0)
        return fail(ErrorKind::badInput,
                    "viewport " + std::to_string(viewport) +
                        " shows nothing yet: a \"view\" or \"slice\" action must come first");
    open(0, View::endoscopic, options_.width, options_.height);
    return {};
}

Status Player::run(const ViewAction& action, ActionReport&) {
    if (isFlat(action.view)) {
        TRY(mustBeFlattened());
    }
    open(action.viewport, action.view, action.width, action.height);
    return {};
}

Status Player::run(const GoAction& action, ActionReport&) {
    if ((action.arcMm || action.fraction) && flight_.centerline().points.empty())
        return fail(ErrorKind::notFound, "the case has no centerline");
    if (action.direction) flight_.setDirection(*action.direction);
    if (action.arcMm) flight_.goTo(*action.arcMm);
    if (action.fraction) flight_.goTo(*action.fraction * flight_.centerline().lengthMm());
    flight_.setLook(action.yawDegrees.value_or(flight_.yawDegrees()),
                    action.pitchDegrees.value_or(flight_.pitchDegrees()));
    if (action.fisheye) flight_.setFisheye(*action.fisheye);
    if (action.fovDegrees) flight_.setFov(*action.fovDegrees);
    return {};
}

Status Player::run(const StillAction& action, ActionReport& report) {
    TRY(mustBeOpen(action.viewport));
    TRY(still(action.viewport, action.png, report));
    return hold(action.holdMs);
}

// The exact picture of viewport 0, and over it what the lens shows there.
Status Player::run(const LensAction& action, ActionReport& report) {
    TRY(mustBeOpen(0));
    if (viewports_[0].view != View::endoscopic)
        return fail(ErrorKind::badInput, "viewport 0 does not show the endoscopic view");
    if (!session_.serverCan(protocol::capability::lens))
        return fail(ErrorKind::unsupported, "this server cannot show a lens");
    const auto preset = action.preset ? action.preset : BiopsyLens::presetOf(*session_.caseInfo());
    if (!preset) return fail(ErrorKind::notFound, "the server has no electronic biopsy");
    const Camera beneath = flight_.camera();
    LensPlace place{action.at.value_or(glm::dvec2(0.0)), action.radius};
    if (action.positionMm) {
        const auto seen = seenAt(beneath, *action.positionMm);
        if (!seen) return fail(ErrorKind::noResult, "the picture does not show this place");
        place.center = *seen;
    }
    const auto camera = cameraOfLens(beneath, place);
    const double halfWidth = 0.5 * viewports_[0].width / viewports_[0].height;
    if (!camera || std::abs(place.center.x) > halfWidth || std::abs(place.center.y) > 0.5)
        return fail(ErrorKind::noResult, "the picture does not show this place");
    const auto start = Clock::now();
    auto picture = TRY(awaitPicture(0, ask(0, false), true)).picture;
    const int viewport = int(protocol::lensViewport);
    session_.setViewport(viewport, View::endoscopic, mostLensPixels, mostLensPixels, true);
    session_.setTransferFunction(viewport, *preset);
    const auto askedAt = Clock::now();
    const auto arrival = TRY(awaitPicture(viewport, session_.look(viewport, *camera, false), true));
    session_.setViewport(viewport, View::endoscopic, 0, 0, true);
    count(report, arrival, askedAt);
    report.seconds = msBetween(start, arrival.decodedAt) / 1000.0;
    if (action.png.empty()) return {};
    report.file = action.png;
    layOver(picture,
            throughLens(arrival.picture, *camera, beneath, place, {picture.width, picture.height}));
    return tiles::writePng(options_.outFolder / action.png, tiles::rgbOf(picture), picture.width,
                           picture.height);
}

Status Player::run(const SliceAction& action, ActionReport& report) {
    const int id = action.viewport.value_or(int(action.view));
    open(id, action.view, action.size).state =
        SliceView{action.view,
                  action.positionMm.value_or(flight_.camera().positionMm),
                  action.zoom,
                  {},
                  action.cleansed ? Scan::cleansed : Scan::original};
    return still(id, action.png, report);
}

Status Player::run(const WindowAction& action, ActionReport&) {
    TRY(mustBeOpen(action.viewport));
    session_.setWindowLevel(action.viewport, action.window);
    return awaitBookmarkList();
}

Status Player::run(const TransferAction& action, ActionReport&) {
    TRY(mustBeOpen(action.viewport));
    const auto sequence = session_.setTransferFunction(action.viewport, action.optics);
    const auto* preset = std::get_if<std::string>(&action.optics);
    optics_[action.viewport] = preset ? *preset : "";
    // The picture that is there is drawn anew.
    if (auto& asked = asked_[action.viewport]; !asked.empty()) {
        Asked last = asked.rbegin()->second;
        last.optics = optics_[action.viewport];
        asked[sequence] = last;
    }
    return awaitBookmarkList();
}

Status Player::run(const BookmarkAction& action, ActionReport& report) {
    const auto start = Clock::now();
    for (int n = 0; n < action.count; ++n) {
        const auto askedAt = Clock::now();
        const std::string key =
            session_.addBookmark(flight_.camera(), flight_.placeArcMm(), action.note);
        const Bookmark* added = nullptr;
        auto came =
            awaitThat([&] { return (added = session_.acknowledgedBookmark(key)) != nullptr; },
                      "the acknowledgement of a bookmark");
        report.seconds = msBetween(start, Clock::now()) / 1000.0;
        if (!came) return came;
        report.latencyMs.push_back(msBetween(askedAt, Clock::now()));
        report.acknowledged.push_back({added->id, key});
    }
    return {};
}

Status Player::run(const BookmarksAction& action, ActionReport& report) {
    TRY(awaitBookmarkList());
    const auto bookmarks = session_.bookmarks();
    report.bookmarks = bookmarks.size();
    if (action.json.empty()) return {};
    const auto triple = [](glm::dvec3 v) { return nlohmann::ordered_json::array({v.x, v.y, v.z}); };
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Bookmark& b : bookmarks)
        list.push_back({{"id", b.id},
                        {"arc_mm", b.arcMm},
                        {"position_mm", triple(b.camera.positionMm)},
                        {"forward", triple(b.camera.forward)},
                        {"up", triple(b.camera.up)},
                        {"note", b.note},
                        {"created_utc", b.createdUtc},
                        {"client_key", b.clientKey}});
    return writeJson(action.json,
                     nlohmann::ordered_json{{"bookmarks", list}}.dump(
                         2, ' ', false, nlohmann::json::error_handler_t::replace) +
                         "\n",
                     report);
}

Status Player::writeJson(const std::string& file, const std::string& text, ActionReport& report) {
    report.file = file;
    return writeDurably(options_.outFolder / file, text);
}

Status Player::run(const WaitAction& action, ActionReport&) {
    return hold(action.ms);
}

// ---- flights --------------------------------------------------------------------------------

Status Player::run(const FlyAction& action, ActionReport& report) {
    if (flight_.centerline().points.empty())
        return fail(ErrorKind::notFound, "the case has no centerline");
    TRY(mustBeOpen(action.viewport));
    if (viewports_[action.viewport].view != View::endoscopic)
        return fail(ErrorKind::badInput, "only an endoscopic viewport can fly");
    const double length = flight_.centerline().lengthMm();
    const bool antegrade = flight_.direction() == FlightDirection::antegrade;
    const double fromMm = std::min(action.fromMm.value_or(antegrade ? 0.0 : length), length);
    const double toMm = std::min(action.toMm.value_or(antegrade ? length : 0.0), length);
    Course course{action.positions, action.viewport, action.pipelined, action.holdMs, {}};
    course.goTo = [&](double part) {
        flight_.goTo(fromMm + (toMm - fromMm) * part);
        return ask(action.viewport, true);
    };
    return travel(course, report);
}

Status Player::run(const FlyOverAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    if (action.endoscopic) {
        TRY(mustBeOpen(0));
        if (viewports_[0].view != View::endoscopic)
            return fail(ErrorKind::badInput, "viewport 0 does not show the endoscopic view");
    }
    OpenViewport& zoom = open(action.viewport, View::flattenedZoom, std::nullopt);
    const FlatStrip& strip = *session_.caseInfo()->flat;
    const double from = std::min(action.from.value_or(0.0), strip.height);
    const double to = std::min(action.to.value_or(strip.height), strip.height);
    FlatWindow window = windowAround(from, action.pixelsPerCircumference, zoom.width);
    Course course{action.positions, action.viewport, action.pipelined, action.holdMs, {}};
    course.goTo = [&](double part) {
        window.center.y = from + (to - from) * part;
        zoom.state = window;
        flight_.goTo(strip.arcAtY(window.center.y));
        if (action.endoscopic) ask(0, true);
        return ask(action.viewport, true);
    };
    passedOver_.clear();
    auto flown = travel(course, report);
    if (action.endoscopic) report.following = passedOver_[0];
    return flown;
}

Status Player::travel(const Course& course, ActionReport& report) {
    report.positions = course.positions;
    report.pipelined = course.pipelined;
    const auto start = Clock::now();
    auto travelled =
        course.pipelined ? travelPipelined(course, report) : travelStepwise(course, report);
    report.seconds = msBetween(start, Clock::now()) / 1000.0;
    return travelled;
}

// One position on its way at a time: what a hand on the mouse feels.
Status Player::travelStepwise(const Course& course, ActionReport& report) {
    for (int n = 0; n < course.positions; ++n) {
        const auto askedAt = Clock::now();
        const auto sequence = course.goTo(double(n) / (course.positions - 1));
        auto arrival = TRY(awaitPicture(course.viewport, sequence, false));
        count(report, arrival, askedAt);
        TRY(hold(course.holdMs));
    }
    return {};
}

// Two positions on their way: the server finds the next one waiting when it has finished a picture.
Status Player::travelPipelined(const Course& course, ActionReport& report) {
    std::map<std::uint64_t, Clock::time_point> askedAt;
    int sent = 0;
    while (sent < course.positions || !askedAt.empty()) {
        while (sent < course.positions && askedAt.size() < 2) {
            const auto now = Clock::now();
            askedAt.emplace(course.goTo(double(sent++) / (course.positions - 1)), now);
        }
        auto arrival = TRY(awaitPicture(course.viewport, askedAt.begin()->first, false));
        // A picture answers its input and all before it that it overtook.
        const auto past = askedAt.upper_bound(arrival.picture.sequence);
        count(report, arrival, std::prev(past)->second);
        askedAt.erase(askedAt.begin(), past);
        TRY(hold(course.holdMs));
    }
    return {};
}

// ---- the flattened wall ---------------------------------------------------------------------

Status Player::mustBeFlattened() {
    if (session_.caseInfo()->flat) return {};
    return fail(ErrorKind::notFound, "the case has not been flattened");
}

FlatWindow Player::windowAround(double y, std::optional<double> pixelsPerCircumference,
                                int width) const {
    return {{0.5, y}, pixelsPerCircumference.value_or(wholeCircumference(width))};
}

Status Player::run(const FlatAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    OpenViewport& zoom = open(action.viewport, View::flattenedZoom, action.size);
    const FlatStrip& strip = *session_.caseInfo()->flat;
    FlatWindow window = windowAround(strip.yAtArc(action.arcMm.value_or(flight_.placeArcMm())),
                                     action.pixelsPerCircumference, zoom.width);
    if (action.center) window.center = *action.center;
    zoom.state = window;
    TRY(still(action.viewport, action.png, report));
    return hold(action.holdMs);
}

Status Player::run(const StripAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    open(action.viewport, View::flattened, action.size);
    TRY(still(action.viewport, action.png, report));
    return hold(action.holdMs);
}

Result<Session::WallAnswer> Player::awaitWallAnswer(std::uint64_t request, ActionReport& report) {
    const auto askedAt = Clock::now();
    std::optional<Session::WallAnswer> found;
    auto came = awaitThat(
        [&] {
            for (Session::WallAnswer& answer : session_.takeWallAnswers())
                if (answer.request == request) found = std::move(answer);
            return found.has_value();
        },
        "the answer about the wall");
    report.seconds = msBetween(askedAt, Clock::now()) / 1000.0;
    if (!came) return tl::make_unexpected(came.error());
    report.latencyMs.push_back(report.seconds * 1000.0);
    return std::move(*found);
}

Status Player::run(const LocateAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    const auto request =
        action.flat ? session_.locate(*action.flat) : session_.locate(*action.positionMm);
    auto answer = TRY(awaitWallAnswer(request, report));
    report.place = std::get<WallPlace>(TRY(std::move(answer.body)));
    return action.json.empty() ? Status{} : writeJson(action.json, toJson(*report.place), report);
}

Status Player::run(const MeasureAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    auto answer = TRY(awaitWallAnswer(session_.measure(action.points, action.closed), report));
    report.measure = std::get<FlatMeasure>(TRY(std::move(answer.body)));
    return action.json.empty() ? Status{} : writeJson(action.json, toJson(*report.measure), report);
}

Status Player::run(const PaintAction& action, ActionReport&) {
    TRY(mustBeFlattened());
    session_.setWallPaint(action.paint);
    return awaitBookmarkList();
}

Status Player::run(const SeenAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    const auto request = session_.askSeen(action.forget);
    TRY(awaitThat([&] { return session_.answeredSeenRequest() >= request; },
                  "the share of the wall that has been seen"));
    report.seenShare = session_.seenShare();
    return action.json.empty()
               ? Status{}
               : writeJson(action.json, seenShareJson(*report.seenShare, seenNow()), report);
}

std::optional<SeenNow> Player::seenNow() const {
    if (!session_.seenShare() || !session_.seenLimits()) return std::nullopt;
    return SeenNow{*session_.seenShare(), session_.seenIsRecorded(), *session_.seenLimits()};
}

Status Player::run(const SeenLimitsAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    const auto request = session_.setSeenLimits(action.limits);
    TRY(awaitThat([&] { return session_.answeredSeenRequest() >= request; },
                  "what counts as seen"));
    if (!session_.seenLimits())
        return fail(ErrorKind::unsupported, "this server counts by limits of its own");
    report.seenShare = session_.seenShare();
    return {};
}

Status Player::run(const MissedAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    const auto request = session_.requestMissed(action.leastMm2);
    TRY(awaitThat([&] { return !session_.awaits(request); }, "the list of missed patches"));
    if (!session_.missed()) return noLedger();
    report.missed = *session_.missed();
    return action.json.empty() ? Status{} : writeJson(action.json, toJson(*report.missed), report);
}

// The list comes first, so that a patch that has been seen is not gone to again.
Status Player::run(const NextMissedAction& action, ActionReport& report) {
    TRY(run(MissedAction{}, report));
    report.missed.reset();
    missed_.want(action.step);
    bool none = false;
    const auto patch = missed_.takeWanted(none);
    if (!patch) return fail(ErrorKind::noResult, "no patch of 300 mm2 or more is left there");
    if (patch->view)
        flight_.goTo(*patch->view, patch->place.arcMm);
    else
        flight_.lookAt(patch->place.arcMm, patch->place.positionMm);
    report.place = patch->place;
    return {};
}

Status Player::settleShown() {
    const auto number = session_.tellShown();
    return awaitThat([&] { return !session_.seenIsRecorded() || session_.keptShown() >= number; },
                     "word that what has been seen is kept");
}

// With all that has been on screen until it is asked for, and that is on the server's disk.
Status Player::run(const LedgerAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    TRY(settleShown());
    const auto request = session_.requestLedger();
    log(session_.takeTold());
    const auto log = log_;
    TRY(awaitThat([&] { return !session_.awaits(request); }, "the ledger"));
    if (!session_.ledger()) return noLedger();
    report.seenShare = session_.ledger()->share;
    return writeJson(action.json, toJson(*session_.ledger(), log), report);
}

Status Player::run(const SeenReportAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    const auto request = session_.requestSeenReport(action.leastMm2);
    TRY(awaitThat([&] { return !session_.awaits(request); }, "the report of what has been seen"));
    if (!session_.seenReport()) return noLedger();
    report.seenReport = *session_.seenReport();
    return action.json.empty()
               ? Status{}
               : writeJson(action.json, toJson(*report.seenReport, session_.caseInfo()->name),
                           report);
}

tl::unexpected<Error> Player::noLedger() {
    return fail(ErrorKind::unsupported, "this server keeps no ledger of what has been seen");
}

// ---- findings -------------------------------------------------------------------------------

Status Player::run(const DetectionAction& action, ActionReport&) {
    FindingsReading findings(session_);
    TRY(findings.choose(action.choice));
    return awaitBookmarkList();
}

Status Player::run(const FindingsAction& action, ActionReport& report) {
    const auto askedAt = Clock::now();
    const auto request = session_.requestFindings();
    TRY(awaitThat([&] { return session_.answeredFindingsRequest() >= request; },
                  "the list of findings"));
    report.seconds = msBetween(askedAt, Clock::now()) / 1000.0;
    if (!session_.findings())
        return fail(ErrorKind::unsupported, "this server cannot list findings");
    report.findings = *session_.findings();
    return action.json.empty() ? Status{}
                               : writeJson(action.json, toJson(*report.findings), report);
}

// The list comes first, so that a script need not ask for it.
Status Player::run(const FindingAction& action, ActionReport& report) {
    TRY(run(FindingsAction{}, report));
    report.findings.reset();
    FindingsReading findings(session_);
    const ListedFinding* found = findings.find(action.number);
    if (!found)
        return fail(ErrorKind::notFound,
                    "finding " + std::to_string(action.number) +
                        (findings.choice().shows()
                             ? " is not listed"
                             : ": findings are not shown in the mode that was chosen"));
    if (found->view)
        flight_.goTo(*found->view, found->wall.arcMm);
    else if (!flight_.centerline().points.empty())
        flight_.lookAt(found->wall.arcMm, found->wall.positionMm);
    report.place = found->wall;
    return {};
}

// ---- across the gaze, and from outside ------------------------------------------------------

ObliqueView Player::obliqueAtCamera() const {
    const Camera camera = flight_.camera();
    return {camera.positionMm, camera.forward, camera.up};
}

Overview Player::overviewFromFront(int width, int height) const {
    return {cameraOf(orbitOf(flight_.centerline(), double(width) / height)), flight_.camera(), {}};
}

Status Player::run(const ObliqueAction& action, ActionReport& report) {
    ObliqueView oblique = obliqueAtCamera();
    if (action.positionMm) oblique.positionMm = *action.positionMm;
    if (action.forward) {
        oblique.forward = glm::normalize(*action.forward);
        oblique.up = *action.up;
    }
    oblique.positionMm += action.aheadMm * oblique.forward;
    oblique.heightMm = action.heightMm;
    oblique.scan = action.cleansed ? Scan::cleansed : Scan::original;
    open(action.viewport, View::oblique, action.size).state = oblique;
    return still(action.viewport, action.png, report);
}

Status Player::run(const OverviewAction& action, ActionReport& report) {
    OpenViewport& viewport = open(action.viewport, View::overview, action.size);
    Orbit orbit = orbitOf(flight_.centerline(), double(viewport.width) / viewport.height);
    orbit.azimuthDegrees = action.azimuthDegrees;
    orbit.elevationDegrees = action.elevationDegrees;
    if (action.heightMm) orbit.heightMm = *action.heightMm;
    Overview overview = overviewFromFront(viewport.width, viewport.height);
    overview.camera = cameraOf(orbit);
    if (!action.reader) overview.reader.reset();
    overview.body = action.body;
    if (action.bookmarks) {
        TRY(awaitBookmarkList());
        for (const Bookmark& bookmark : session_.bookmarks())
            if (overview.bookmarksMm.size() < maxOverviewBookmarks)
                overview.bookmarksMm.push_back(bookmark.camera.positionMm);
    }
    viewport.state = std::move(overview);
    return still(action.viewport, action.png, report);
}

}  // namespace

PlayReport play(Session& session, const std::vector<Action>& actions, const PlayOptions& options) {
    PlayReport report;
    report.clientSoftware = options.software;
    Player player(session, options);
    const auto finish = [&](std::optional<Error> failure) {
        report.serverSoftware = session.server().serverSoftware;
        report.renderer = session.server().renderer;
        report.fingerprint = session.server().fingerprint;
        report.roundTripMs = session.roundTripMs();
        report.seen = player.seenNow();
        report.failure = std::move(failure);
        return std::move(report);
    };
    if (auto opened = player.awaitCase(); !opened) return finish(opened.error());
    report.caseName = session.caseInfo()->name;
    report.bridges = bridgesOf(session.caseInfo()->centerline);
    report.trust = session.caseInfo()->trust;
    report.centerlineMm = session.caseInfo()->centerline.lengthMm();
    for (const Action& action : actions) {
        ActionReport measured;
        measured.line = action.line;
        measured.name = action.name;
        auto done = player.play(action, measured);
        report.actions.push_back(std::move(measured));
        if (done) continue;
        Error error = done.error();
        const std::string line =
            options.scriptName + ":" + std::to_string(action.line) + ": " + action.name;
        error.place = error.place.empty() ? line : line + ": " + error.place;
        return finish(std::move(error));
    }
    // Nothing that has been seen is lost with the link.
    if (auto settled = player.settleShown(); !settled) return finish(settled.error());
    return finish(std::nullopt);
}

}  // namespace haustra::reader
