#include "script/player.h"

#include "core/raycasters.h"
#include "script/report.h"
#include "tiles/png_file.h"

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

namespace haustra::reader {

using Status = Player::Status;

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
    report.raycaster = raycasterName(picture.raycaster);
    report.coarse += picture.coarse;
    report.bytes += picture.wireBytes;
}

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

Status Player::awaitStill(int viewport, std::uint64_t sequence, Clock::time_point askedAt,
                          const std::string& png, ActionReport& report) {
    auto arrival = TRY(awaitPicture(viewport, sequence, true));
    count(report, arrival, askedAt);
    report.seconds = msBetween(askedAt, arrival.decodedAt) / 1000.0;
    if (png.empty()) return {};
    report.file = png;
    return tiles::writePng(options_.outFolder / png, arrival.picture.rgb, arrival.picture.width,
                           arrival.picture.height);
}

// ---- actions --------------------------------------------------------------------------------

Player::OpenViewport& Player::open(int viewport, View view, int width, int height) {
    const auto found = viewports_.find(viewport);
    if (found != viewports_.end() && found->second.view == view && found->second.width == width &&
        found->second.height == height)
        return found->second;
    FlatWindow window;
    if (const auto& strip = session_.caseInfo()->flat)
        window = windowAround(strip->yAtArc(flight_.arcMm()), std::nullopt, width);
    session_.setViewport(viewport, view, width, height);
    return viewports_[viewport] = {view,
                                   width,
                                   height,
                                   Slice{flight_.camera().positionMm},
                                   window,
                                   obliqueAtCamera(),
                                   overviewFromFront(width, height)};
}

Player::OpenViewport& Player::open(int viewport, View view, std::optional<glm::ivec2> size) {
    const auto found = viewports_.find(viewport);
    if (!size && found != viewports_.end() && found->second.view == view) return found->second;
    const glm::ivec2 pixels = size.value_or(glm::ivec2(options_.width, options_.height));
    return open(viewport, view, pixels.x, pixels.y);
}

// Asks for what the viewport is to show now.
std::uint64_t Player::ask(int id, bool moving) {
    const OpenViewport& viewport = viewports_.at(id);
    if (viewport.view == View::endoscopic) return session_.setCamera(id, flight_.camera(), moving);
    if (isFlat(viewport.view)) return session_.setFlat(id, viewport.window, moving);
    if (viewport.view == View::oblique) return session_.setOblique(id, viewport.oblique, moving);
    if (viewport.view == View::overview) return session_.setOverview(id, viewport.overview, moving);
    return session_.setSlice(id, viewport.slice, moving);
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
    const auto askedAt = Clock::now();
    return awaitStill(action.viewport, ask(action.viewport, false), askedAt, action.png, report);
}

Status Player::run(const SliceAction& action, ActionReport& report) {
    const int id = action.viewport.value_or(int(action.view));
    open(id, action.view, action.size).slice = {
        action.positionMm.value_or(flight_.camera().positionMm), action.zoom, action.cleansed};
    const auto askedAt = Clock::now();
    return awaitStill(id, ask(id, false), askedAt, action.png, report);
}

Status Player::run(const WindowAction& action, ActionReport&) {
    TRY(mustBeOpen(action.viewport));
    session_.setWindowLevel(action.viewport, action.window);
    return awaitBookmarkList();
}

Status Player::run(const TransferAction& action, ActionReport&) {
    TRY(mustBeOpen(action.viewport));
    session_.setTransferFunction(action.viewport, action.optics);
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
    std::ofstream out(options_.outFolder / file);
    out << text;
    if (!out.flush()) return fail(ErrorKind::io, "cannot write the file", file);
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

}  // namespace haustra::reader
