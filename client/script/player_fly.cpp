// Travelling actions: along the path, and over the flattened strip.
#include "script/player.h"

#include <algorithm>

namespace haustra::reader {

using Status = Player::Status;

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
    Course course{action.positions, action.viewport, action.pipelined, {}};
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
    zoom.window = windowAround(from, action.pixelsPerCircumference, zoom.width);
    Course course{action.positions, action.viewport, action.pipelined, {}};
    course.goTo = [&](double part) {
        zoom.window.center.y = from + (to - from) * part;
        flight_.goTo(strip.arcAtY(zoom.window.center.y));
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
    }
    return {};
}

}  // namespace haustra::reader
