#include "reader/missed_reading.h"

#include "protocol/capabilities.h"

#include <algorithm>
#include <utility>

namespace haustra::reader {
namespace {

// The middle of a patch moves while parts of it are seen.
constexpr double samePatchMm = 10.0;
constexpr auto askEvery = std::chrono::milliseconds(1000);
constexpr auto askAfterRefusal = std::chrono::seconds(30);

}  // namespace

void MissedReading::open() {
    wanted_.reset();
    visited_.clear();
    at_ = 0;
    askedAtShare_.reset();
    asked_ = 0;
    askAfter_ = {};
}

bool MissedReading::has() const {
    return session_.caseInfo() && session_.caseInfo()->flat &&
           session_.serverCan(protocol::capability::ledger);
}

const MissedList* MissedReading::list() const {
    return session_.missed() ? &*session_.missed() : nullptr;
}

void MissedReading::update(Clock::time_point now) {
    if (!has() || session_.phase() != Phase::open || !session_.seenShare()) return;
    const bool waits = session_.awaits(asked_);
    if (asked_ > 0 && !waits && !list()) {  // refused, which the session has told
        asked_ = 0;
        askAfter_ = now + askAfterRefusal;
        wanted_.reset();
    }
    // Forgotten, or by stricter limits: another review.
    if (askedAtShare_ && *session_.seenShare() < *askedAtShare_) {
        visited_.clear();
        at_ = 0;
        askedAtShare_.reset();
    }
    const bool stale = !list() || askedAtShare_ != session_.seenShare();
    if (waits || !stale || now < askAfter_ || (!watched_ && !wanted_ && visited_.empty())) return;
    askedAtShare_ = session_.seenShare();
    asked_ = session_.requestMissed();
    askAfter_ = now + askEvery;
}

std::optional<std::size_t> MissedReading::patchAt(glm::dvec3 placeMm) const {
    if (!list()) return std::nullopt;
    std::optional<std::size_t> nearest;
    double least = samePatchMm;
    for (std::size_t n = 0; n < list()->patches.size(); ++n) {
        const double apart = glm::distance(list()->patches[n].place.positionMm, placeMm);
        if (apart < least) least = apart, nearest = n;
    }
    return nearest;
}

std::optional<std::size_t> MissedReading::current() const {
    return visited_.empty() ? std::nullopt : patchAt(visited_[at_]);
}

void MissedReading::setCurrent(std::size_t patch) {
    visited_.push_back(list()->patches[patch].place.positionMm);
    at_ = visited_.size() - 1;
}

std::optional<std::size_t> MissedReading::firstUnvisited() const {
    // A visit is of one patch: the faces of a fold may lie closer than a patch's middle moves.
    std::vector<bool> been(list()->patches.size(), false);
    for (const glm::dvec3& placeMm : visited_)
        if (const auto patch = patchAt(placeMm)) been[*patch] = true;
    const auto first = std::find(been.begin(), been.end(), false);
    return first == been.end() ? std::nullopt : std::optional(std::size_t(first - been.begin()));
}

std::optional<MissedPlace> MissedReading::takeWanted(bool& none) {
    none = false;
    if (!wanted_ || !list()) return std::nullopt;
    const bool onward = *std::exchange(wanted_, std::nullopt) > 0;
    // Along the way that was gone, over what has been seen meanwhile.
    std::optional<std::size_t> to;
    const auto goTo = [&](std::size_t visit) {
        to = patchAt(visited_[visit]);
        if (to) at_ = visit;
    };
    if (onward)
        for (std::size_t n = at_ + 1; n < visited_.size() && !to; ++n)
            goTo(n);
    else
        for (std::size_t n = visited_.empty() ? 0 : at_; n > 0 && !to;)
            goTo(--n);
    if (onward && !to) {
        to = firstUnvisited();
        if (!to && !list()->patches.empty()) visited_.clear(), to = 0;  // another round
        if (to) setCurrent(*to);
    }
    none = !to;
    if (none) return std::nullopt;
    return list()->patches[*to];
}

}  // namespace haustra::reader
