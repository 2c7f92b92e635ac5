// Actions on the flattened wall: its pictures, places and measurements.
#include "reader/strip_tour.h"
#include "script/player.h"

namespace haustra::reader {

using Status = Player::Status;

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
    zoom.window = windowAround(strip.yAtArc(action.arcMm.value_or(flight_.arcMm())),
                               action.pixelsPerCircumference, zoom.width);
    if (action.center) zoom.window.center = *action.center;
    const auto askedAt = Clock::now();
    return awaitStill(action.viewport, ask(action.viewport, false), askedAt, action.png, report);
}

Status Player::run(const StripAction& action, ActionReport& report) {
    TRY(mustBeFlattened());
    open(action.viewport, View::flattened, action.size);
    const auto askedAt = Clock::now();
    return awaitStill(action.viewport, ask(action.viewport, false), askedAt, action.png, report);
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
    return action.json.empty() ? Status{}
                               : writeJson(action.json, seenShareJson(*report.seenShare), report);
}

}  // namespace haustra::reader
