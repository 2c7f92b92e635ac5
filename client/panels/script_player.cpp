#include "panels/script_player.h"

#include "tiles/png_file.h"

#include <algorithm>
#include <fstream>
#include <functional>

#include <nlohmann/json.hpp>

namespace haustra::panels {
namespace {

using Status = Result<void>;

double msBetween(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
}

void count(ActionReport& report, const Arrival& arrival, Clock::time_point askedAt) {
    const tiles::Picture& picture = arrival.picture;
    report.latencyMs.push_back(msBetween(askedAt, arrival.decodedAt));
    report.decodeMs.push_back(picture.decodeMs);
    report.renderMicroseconds.push_back(picture.renderMicroseconds);
    report.encodeMicroseconds.push_back(picture.encodeMicroseconds);
    report.queueMicroseconds.push_back(picture.queueMicroseconds);
    report.bytes += picture.wireBytes;
}

class Player {
public:
    Player(Session& session, const PlayOptions& options)
        : session_(session), options_(options), flight_({}) {}

    Status awaitCase();
    Status play(const Action& action, ActionReport& report) {
        return std::visit([&](const auto& body) { return run(body, report); }, action.body);
    }

private:
    struct OpenViewport {
        View view;
        int width, height;
        Slice slice;
    };

    Status run(const ViewAction&, ActionReport&);
    Status run(const GoAction&, ActionReport&);
    Status run(const FlyAction&, ActionReport&);
    Status run(const StillAction&, ActionReport&);
    Status run(const SliceAction&, ActionReport&);
    Status run(const WindowAction&, ActionReport&);
    Status run(const TransferAction&, ActionReport&);
    Status run(const BookmarkAction&, ActionReport&);
    Status run(const BookmarksAction&, ActionReport&);
    Status run(const WaitAction&, ActionReport&);

    Status flyStepwise(const FlyAction&, double fromMm, double toMm, ActionReport&);
    Status flyPipelined(const FlyAction&, double fromMm, double toMm, ActionReport&);

    void open(int viewport, View view, int width, int height);
    Status mustBeOpen(int viewport);
    Status awaitStill(int viewport, std::uint64_t sequence, Clock::time_point askedAt,
                      const std::string& png, ActionReport& report);
    Result<Arrival> awaitPicture(int viewport, std::uint64_t sequence, bool exact);
    Status awaitBookmarkList();
    Status awaitThat(const std::function<bool()>& done, const std::string& what);

    Session& session_;
    const PlayOptions& options_;
    Flight flight_;
    std::map<int, OpenViewport> viewports_;
    std::deque<Arrival> arrivals_;
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
    const auto& names = session_.caseNames();
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

Result<Arrival> Player::awaitPicture(int viewport, std::uint64_t sequence, bool exact) {
    Result<Arrival> found = fail(ErrorKind::noResult, "");
    const auto look = [&] {
        for (Arrival& arrival : session_.takePictures())
            arrivals_.push_back(std::move(arrival));
        while (!found && !arrivals_.empty()) {
            const tiles::Picture& picture = arrivals_.front().picture;
            if (picture.viewport == viewport && picture.sequence >= sequence &&
                (picture.exact || !exact))
                found = std::move(arrivals_.front());
            arrivals_.pop_front();
        }
        return bool(found);
    };
    const std::string what = exact ? "the exact picture" : "the picture";
    if (auto came = awaitThat(look, what + " of viewport " + std::to_string(viewport)); !came)
        return tl::make_unexpected(came.error());
    return found;
}

Status Player::awaitStill(int viewport, std::uint64_t sequence, Clock::time_point askedAt,
                          const std::string& png, ActionReport& report) {
    auto arrival = awaitPicture(viewport, sequence, true);
    if (!arrival) return tl::make_unexpected(arrival.error());
    count(report, *arrival, askedAt);
    report.seconds = msBetween(askedAt, arrival->decodedAt) / 1000.0;
    if (png.empty()) return {};
    report.file = png;
    return tiles::writePng(options_.outFolder / png, arrival->picture.rgb, arrival->picture.width,
                           arrival->picture.height);
}

// ---- actions --------------------------------------------------------------------------------

void Player::open(int viewport, View view, int width, int height) {
    const auto found = viewports_.find(viewport);
    if (found != viewports_.end() && found->second.view == view && found->second.width == width &&
        found->second.height == height)
        return;
    viewports_[viewport] = {view, width, height, Slice{flight_.camera().positionMm}};
    session_.setViewport(viewport, view, width, height);
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
    if (action.fovDegrees) flight_.setFov(*action.fovDegrees);
    return {};
}

Status Player::run(const FlyAction& action, ActionReport& report) {
    if (flight_.centerline().points.empty())
        return fail(ErrorKind::notFound, "the case has no centerline");
    if (auto opened = mustBeOpen(action.viewport); !opened) return opened;
    if (viewports_[action.viewport].view != View::endoscopic)
        return fail(ErrorKind::badInput, "only an endoscopic viewport can fly");
    const double length = flight_.centerline().lengthMm();
    const bool antegrade = flight_.direction() == FlightDirection::antegrade;
    const double fromMm = std::min(action.fromMm.value_or(antegrade ? 0.0 : length), length);
    const double toMm = std::min(action.toMm.value_or(antegrade ? length : 0.0), length);
    report.positions = action.positions;
    report.pipelined = action.pipelined;
    const auto start = Clock::now();
    auto flown = action.pipelined ? flyPipelined(action, fromMm, toMm, report)
                                  : flyStepwise(action, fromMm, toMm, report);
    report.seconds = msBetween(start, Clock::now()) / 1000.0;
    return flown;
}

// One camera on its way at a time: what a hand on the mouse feels.
Status Player::flyStepwise(const FlyAction& action, double fromMm, double toMm,
                           ActionReport& report) {
    for (int n = 0; n < action.positions; ++n) {
        flight_.goTo(fromMm + (toMm - fromMm) * n / (action.positions - 1));
        const auto askedAt = Clock::now();
        const auto sequence = session_.setCamera(action.viewport, flight_.camera(), true);
        auto arrival = awaitPicture(action.viewport, sequence, false);
        if (!arrival) return tl::make_unexpected(arrival.error());
        count(report, *arrival, askedAt);
    }
    return {};
}

// Two cameras on their way: the server finds the next one waiting when it has finished a picture.
Status Player::flyPipelined(const FlyAction& action, double fromMm, double toMm,
                            ActionReport& report) {
    std::map<std::uint64_t, Clock::time_point> askedAt;
    int sent = 0;
    while (sent < action.positions || !askedAt.empty()) {
        while (sent < action.positions && askedAt.size() < 2) {
            flight_.goTo(fromMm + (toMm - fromMm) * sent++ / (action.positions - 1));
            const auto now = Clock::now();
            askedAt.emplace(session_.setCamera(action.viewport, flight_.camera(), true), now);
        }
        auto arrival = awaitPicture(action.viewport, askedAt.begin()->first, false);
        if (!arrival) return tl::make_unexpected(arrival.error());
        // A picture answers its input and all before it that it overtook.
        const auto past = askedAt.upper_bound(arrival->picture.sequence);
        count(report, *arrival, std::prev(past)->second);
        askedAt.erase(askedAt.begin(), past);
    }
    return {};
}

Status Player::run(const StillAction& action, ActionReport& report) {
    if (auto opened = mustBeOpen(action.viewport); !opened) return opened;
    const OpenViewport& viewport = viewports_[action.viewport];
    const auto askedAt = Clock::now();
    const auto sequence = viewport.view == View::endoscopic
                              ? session_.setCamera(action.viewport, flight_.camera(), false)
                              : session_.setSlice(action.viewport, viewport.slice, false);
    return awaitStill(action.viewport, sequence, askedAt, action.png, report);
}

Status Player::run(const SliceAction& action, ActionReport& report) {
    const int id = action.viewport.value_or(int(action.view));
    const auto found = viewports_.find(id);
    const bool keepsSize =
        found != viewports_.end() && found->second.view == action.view && !action.size;
    const glm::ivec2 size = keepsSize
                                ? glm::ivec2(found->second.width, found->second.height)
                                : action.size.value_or(glm::ivec2(options_.width, options_.height));
    open(id, action.view, size.x, size.y);
    const Slice slice{action.positionMm.value_or(flight_.camera().positionMm), action.zoom,
                      action.cleansed};
    viewports_[id].slice = slice;
    const auto askedAt = Clock::now();
    return awaitStill(id, session_.setSlice(id, slice, false), askedAt, action.png, report);
}

Status Player::run(const WindowAction& action, ActionReport&) {
    if (auto opened = mustBeOpen(action.viewport); !opened) return opened;
    session_.setWindowLevel(action.viewport, action.window);
    return awaitBookmarkList();
}

Status Player::run(const TransferAction& action, ActionReport&) {
    if (auto opened = mustBeOpen(action.viewport); !opened) return opened;
    session_.setTransferFunction(action.viewport, action.preset);
    return awaitBookmarkList();
}

Status Player::run(const BookmarkAction& action, ActionReport& report) {
    const auto start = Clock::now();
    for (int n = 0; n < action.count; ++n) {
        const auto askedAt = Clock::now();
        const std::string key =
            session_.addBookmark(flight_.camera(), flight_.arcMm(), action.note);
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
    if (auto came = awaitBookmarkList(); !came) return came;
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
    report.file = action.json;
    std::ofstream out(options_.outFolder / action.json);
    out << nlohmann::ordered_json{{"bookmarks", list}}.dump(
               2, ' ', false, nlohmann::json::error_handler_t::replace)
        << "\n";
    if (!out.flush()) return fail(ErrorKind::io, "cannot write the bookmarks", action.json);
    return {};
}

Status Player::run(const WaitAction& action, ActionReport&) {
    const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                          std::chrono::duration<double, std::milli>(action.ms));
    while (Clock::now() < until) {
        session_.poll(
            std::min(std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()) +
                         std::chrono::milliseconds(1),
                     std::chrono::milliseconds(100)));
        if (session_.phase() == Phase::failed) return tl::make_unexpected(session_.failure());
    }
    return {};
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
        report.failure = std::move(failure);
        return std::move(report);
    };
    if (auto opened = player.awaitCase(); !opened) return finish(opened.error());
    report.caseName = session.caseInfo()->name;
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
    return finish(std::nullopt);
}

}  // namespace haustra::panels
